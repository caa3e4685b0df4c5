// The cloth, in one of three looks, each compiled by itself: LOOK is 0 woven, 1 wireframe, 2 strain colours. (A processor
// that stands in for a graphics card would run all the branches of a condition for every pixel.) With QUICK the light
// comes from the vertices and is a factor to sRGB colours; see cloth.vert.
#ifdef QUICK
in vec3 face_light, back_light;
#else
in vec3 world;
in vec3 world_normal;
#endif
in float particle_strain;
in vec2 grid;

out vec4 colour;

#if LOOK == 0

uniform sampler2D weave;  // linear when sampled; with QUICK as it is stored, sRGB
uniform vec2 tiles_per_cell;

vec3 albedo() {
  return texture(weave, grid * tiles_per_cell).rgb;
}

#elif LOOK == 1

uniform vec2 last_cell;      // columns - 1, rows - 1
uniform float line_width;    // px
uniform vec3 sheet_colour;   // linear; with QUICK the square of sRGB
uniform vec3 thread_colour;  // likewise

vec3 albedo() {
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
  vec3 mixed = mix(sheet_colour, thread_colour, cover);
#ifdef QUICK
  return sqrt(mixed);
#else
  return mixed;
#endif
}

#else

uniform sampler2D strain_palette;  // one row; linear when sampled; with QUICK as it is stored, sRGB
uniform float strain_maximum;

vec3 albedo() {
  float fraction = clamp(particle_strain / strain_maximum, 0.0, 1.0);
  return texture(strain_palette, vec2((fraction * 255.0 + 0.5) / 256.0, 0.5)).rgb;
}

#endif

#ifdef QUICK

void main() {
  colour = vec4(albedo() * (gl_FrontFacing ? face_light : back_light), 1.0);
}

#else

void main() {
  vec3 n = normalize(gl_FrontFacing ? world_normal : -world_normal);
#if LOOK == 0
  vec3 seen = lit(gl_FrontFacing ? albedo() : back_of_cloth * albedo(), n, world, 0.15, 0.20, 0.05);
#elif LOOK == 1
  vec3 seen = lit(gl_FrontFacing ? albedo() : back_of_sheet * albedo(), n, world, 0.35, 0.1, 0.02);
#else
  vec3 seen = albedo() * strain_shade(n);
#endif
  colour = vec4(encode_srgb(seen), 1.0);
}

#endif
