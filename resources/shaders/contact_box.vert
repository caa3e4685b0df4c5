// The twelve edges of a box, as lines of a given width on the screen: an instance for each box, six vertices for
// each edge.
layout(location = 0) in vec3 lower;  // m
layout(location = 1) in vec3 upper;

uniform mat4 world_to_clip;
uniform mat3 turn;   // of the body that the boxes belong to
uniform vec3 shift;  // m
uniform vec2 viewport;  // px
uniform float width;    // px

void main() {
  int edge = gl_VertexID / 6, part = gl_VertexID % 6;
  int axis = edge / 4;
  vec3 first = vec3(0.0), last;
  first[(axis + 1) % 3] = float(edge & 1);
  first[(axis + 2) % 3] = float((edge >> 1) & 1);
  last = first;
  last[axis] = 1.0;
  vec4 from = world_to_clip * vec4(turn * mix(lower, upper, first) + shift, 1.0);
  vec4 to = world_to_clip * vec4(turn * mix(lower, upper, last) + shift, 1.0);
  vec2 along = (to.xy / to.w - from.xy / from.w) * viewport;
  float distance = length(along);
  vec2 across = distance > 0.0 ? vec2(-along.y, along.x) / distance : vec2(0.0);
  // Two triangles: from-left, from-right, to-left; to-left, from-right, to-right.
  bool at_end = part == 2 || part == 3 || part == 5, right = part == 1 || part == 4 || part == 5;
  vec4 here = at_end ? to : from;
  here.xy += (right ? 1.0 : -1.0) * width / viewport * across * here.w;
  here.z -= 0.0005 * here.w;
  gl_Position = from.w > 0.0 && to.w > 0.0 ? here : vec4(2.0, 2.0, 2.0, 1.0);
}
