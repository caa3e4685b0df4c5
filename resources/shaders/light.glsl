// Shared by all surfaces: Blinn-Phong in linear light. One key light, a soft fill from beside the eye, and an ambient
// term that is brighter from above than from below.
uniform vec3 eye;             // m
uniform vec3 key_direction;   // unit, towards the light
uniform vec3 fill_direction;  // unit, towards the light
uniform float exposure;

const vec3 key_colour = vec3(1.00, 0.97, 0.92);
const vec3 fill_colour = vec3(0.88, 0.94, 1.00);

// The back of a cloth is a little duller and cooler than its face.
const vec3 back_of_cloth = vec3(0.80, 0.84, 0.90);
const vec3 back_of_sheet = vec3(0.82);

// The sRGB curve by square roots (I. Taylor's fit, within 0.002): a processor that stands in for a graphics card takes
// roots in one instruction, and powers in forty.
vec3 encode_srgb(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0);
  vec3 r2 = sqrt(c), r4 = sqrt(r2), r8 = sqrt(r4);
  return clamp(0.662002687 * r2 + 0.684122060 * r4 - 0.323583601 * r8 - 0.022541147 * c, 0.0, 1.0);
}

// Rolls highlights off instead of clipping them; the identity for dark and middle tones.
vec3 soft_clip(vec3 c) {
  vec3 over = max(c - 0.7, 0.0);
  return min(c, 0.7) + over / (1.0 + over / 0.3);
}

// What reaches a sheet of albedo 1. n: unit normal on the viewer's side. wrap softens the terminator as cloth does;
// through: share of the key light that a thin sheet lets shine through from behind.
vec3 diffuse_light(vec3 n, float wrap, float through) {
  float facing = dot(n, key_direction);
  float key = max((facing + wrap) / (1.0 + wrap), 0.0) + through * max(-facing, 0.0);
  float fill = max(dot(n, fill_direction), 0.0);
  float sky = 0.5 + 0.5 * n.y;
  return mix(vec3(0.13, 0.125, 0.12), vec3(0.27, 0.28, 0.30), sky) + 0.86 * key * key_colour +
         0.16 * fill * fill_colour;
}

// Blinn-Phong's specular term at an exponent of 16, of strength `gloss`.
vec3 highlight(vec3 n, vec3 position, float gloss) {
  float half_way = max(dot(n, normalize(normalize(eye - position) + key_direction)), 0.0);
  float squared = half_way * half_way, fourth = squared * squared, eighth = fourth * fourth;
  return gloss * eighth * eighth * clamp(5.0 * dot(n, key_direction), 0.0, 1.0) * key_colour;
}

vec3 lit(vec3 albedo, vec3 n, vec3 position, float wrap, float through, float gloss) {
  return soft_clip(exposure * (albedo * diffuse_light(n, wrap, through) + highlight(n, position, gloss)));
}

// Form in the strain colours is told by a little shading only: they must stay readable against the bar.
float strain_shade(vec3 n) {
  return 0.78 + 0.22 * clamp(0.55 + 0.6 * dot(n, key_direction), 0.0, 1.0);
}
