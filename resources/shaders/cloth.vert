layout(location = 0) in vec3 position;  // m
layout(location = 1) in vec3 normal;
layout(location = 2) in float strain;
layout(location = 3) in vec2 cell;  // column, row

uniform mat4 world_to_clip;

out vec3 world;
out vec3 world_normal;
out float particle_strain;
out vec2 grid;

void main() {
  world = position;
  world_normal = normal;
  particle_strain = strain;
  grid = cell;
  gl_Position = world_to_clip * vec4(position, 1.0);
}
