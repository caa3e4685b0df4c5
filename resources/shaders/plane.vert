// A square piece of an endless plane.
uniform mat4 world_to_clip;
uniform vec3 middle, axis_u, axis_v;  // m; unit vectors within the plane
uniform float reach;                  // m, half of the square's side

out vec2 on_plane;  // m, from `middle`
out vec3 world;

void main() {
  vec2 corner = vec2(gl_VertexID % 2, gl_VertexID / 2) * 2.0 - 1.0;
  on_plane = reach * corner;
  world = middle + on_plane.x * axis_u + on_plane.y * axis_v;
  gl_Position = world_to_clip * vec4(world, 1.0);
}
