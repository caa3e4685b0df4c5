// The edges of a cloth from a mesh.
uniform vec3 thread_colour;  // sRGB

out vec4 colour;

void main() {
  colour = vec4(thread_colour, 1.0);
}
