layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

uniform mat4 world_to_clip;
uniform vec3 center;  // m
uniform mat3 turn;
uniform vec3 scale;   // m

out vec3 world;
out vec3 world_normal;

void main() {
  world = center + turn * (scale * position);
  world_normal = turn * (normal / scale);
  gl_Position = world_to_clip * vec4(world, 1.0);
}
