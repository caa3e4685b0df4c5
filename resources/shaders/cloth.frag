// The cloth, in one of three looks, each compiled by itself: LOOK is 0 woven, 1 wireframe, 2 strain colours. (A processor
// that stands in for a graphics card would run all the branches of a condition for every pixel.)
in vec3 world;
in vec3 world_normal;
in float particle_strain;
in vec2 grid;

out vec4 colour;

#if LOOK == 0

uniform sampler2D weave;
uniform vec2 tiles_per_cell;

vec3 seen(vec3 n) {
  vec3 albedo = texture(weave, grid * tiles_per_cell).rgb;
  // The back of a cloth is a little duller and cooler than its face.
  if (!gl_FrontFacing) albedo *= vec3(0.80, 0.84, 0.90);
  return lit(albedo, n, world, 0.15, 0.20, 0.05);
}

#elif LOOK == 1

uniform vec2 last_cell;      // columns - 1, rows - 1
uniform float line_width;    // px
uniform vec3 sheet_colour;   // linear
uniform vec3 thread_colour;  // linear

vec3 seen(vec3 n) {
  vec2 per_pixel = max(fwidth(grid), vec2(1e-6));  // cells per pixel
  vec2 to_line = abs(fract(grid - 0.5) - 0.5) / per_pixel;
  vec2 to_hem = min(grid, last_cell - grid) / per_pixel;
  // Half of a hem's line lies outside the sheet, so it is drawn twice as wide.
  vec2 half_width = 0.5 * line_width * mix(vec2(1.0), vec2(2.0), lessThan(to_hem, vec2(line_width + 1.0)));
  vec2 line = 1.0 - smoothstep(half_width - 0.5, half_width + 0.5, to_line);
  // Lines closer than a few pixels melt into their mean grey instead of a moire.
  vec2 mean = min(line_width * per_pixel, 1.0);
  line = mix(line, mean, smoothstep(0.22, 0.5, per_pixel));
  float cover = 1.0 - (1.0 - line.x) * (1.0 - line.y);
  vec3 sheet = gl_FrontFacing ? sheet_colour : 0.82 * sheet_colour;
  return lit(mix(sheet, thread_colour, cover), n, world, 0.35, 0.1, 0.02);
}

#else

uniform sampler2D strain_palette;  // one row, sRGB
uniform float strain_maximum;

vec3 seen(vec3 n) {
  float fraction = clamp(particle_strain / strain_maximum, 0.0, 1.0);
  vec3 albedo = texture(strain_palette, vec2((fraction * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  // Form is told by a little shading only: colours must stay readable against the bar.
  float shade = 0.78 + 0.22 * clamp(0.55 + 0.6 * dot(n, key_direction), 0.0, 1.0);
  return albedo * shade;
}

#endif

void main() {
  vec3 n = normalize(gl_FrontFacing ? world_normal : -world_normal);
  colour = vec4(encode_srgb(seen(n)), 1.0);
}
