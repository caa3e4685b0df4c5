uniform vec3 line_colour;  // sRGB
uniform float opacity;

out vec4 colour;

void main() {
  colour = vec4(line_colour, opacity);
}
