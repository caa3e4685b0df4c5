// A round marker: a disc with a thin rim.
uniform float diameter;  // px
uniform vec3 disc_colour, rim_colour;  // sRGB

out vec4 colour;

void main() {
  float r = length(gl_PointCoord - 0.5) * diameter;
  float outer = 0.5 * diameter - 0.5;
  float inside = clamp(outer + 0.5 - r, 0.0, 1.0);
  if (inside <= 0.0) discard;
  float rim = smoothstep(-0.5, 0.5, r - (outer - 0.18 * diameter));
  colour = vec4(mix(disc_colour, rim_colour, rim), inside);
}
