// A normal, as a line of a given width on the screen: an instance for each touch, a strip of four vertices.
layout(location = 0) in vec3 point;   // m
layout(location = 1) in vec3 normal;
layout(location = 2) in float push;   // share of the strongest

uniform mat4 world_to_clip;
uniform vec2 viewport;  // px
uniform float width;    // px
uniform float reach;    // m, of the strongest

void main() {
  vec4 from = world_to_clip * vec4(point, 1.0);
  vec4 to = world_to_clip * vec4(point + reach * (0.3 + 0.7 * sqrt(push)) * normal, 1.0);
  vec2 along = (to.xy / to.w - from.xy / from.w) * viewport;
  float distance = length(along);
  vec2 across = distance > 0.0 ? vec2(-along.y, along.x) / distance : vec2(0.0);
  vec4 here = gl_VertexID < 2 ? from : to;
  here.xy += (gl_VertexID % 2 == 0 ? -1.0 : 1.0) * width / viewport * across * here.w;
  here.z -= 0.002 * here.w;  // over the cloth, not in it
  gl_Position = from.w > 0.0 && to.w > 0.0 ? here : vec4(2.0, 2.0, 2.0, 1.0);
}
