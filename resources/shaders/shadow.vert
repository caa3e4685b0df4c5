// What throws a shadow, flattened onto a plane along the light.
layout(location = 0) in vec3 position;

uniform mat4 world_to_clip;
uniform vec3 center;  // m, of a body; its place as for solid.vert
uniform mat3 turn;
uniform vec3 scale;
uniform vec3 on_plane;  // m
uniform vec3 normal;    // unit vector
uniform vec3 fall;      // along the light, as far as it takes to lose a metre of height above the plane

void main() {
  vec3 world = center + turn * (scale * position);
  gl_Position = world_to_clip * vec4(world + max(dot(normal, world - on_plane), 0.0) * fall, 1.0);
}
