uniform vec4 shade;  // sRGB and opacity

out vec4 colour;

void main() {
  colour = shade;
}
