// Obstacles: a matte, neutral body that stays behind the cloth in importance.
in vec3 world;
in vec3 world_normal;

uniform vec3 body_colour;  // linear
uniform float opacity;

out vec4 colour;

void main() {
  vec3 n = normalize(world_normal);
  float edge = 1.0 - max(dot(n, normalize(eye - world)), 0.0), rim = edge * edge * edge;
  colour = vec4(encode_srgb(lit(body_colour, n, world, 0.3, 0.0, 0.06) + 0.05 * rim), opacity);
}
