// With QUICK the light is worked out here instead of for every pixel, for both sides, and as the factor that it is to a
// colour that is sRGB already: (a b)^(1/2.2) = a^(1/2.2) b^(1/2.2). For cells of a few pixels nobody sees the difference,
// and a processor that stands in for a graphics card, which shades sixteen pixels for a triangle of seven, needs half
// the time.
layout(location = 0) in vec3 position;  // m
layout(location = 1) in vec3 normal;
layout(location = 2) in float strain;
layout(location = 3) in vec2 cell;  // column, row

uniform mat4 world_to_clip;

#ifdef QUICK

out vec3 face_light, back_light;

vec3 as_factor(vec3 light) {
  return pow(light, vec3(1.0 / 2.2));
}

vec3 light_on(vec3 n) {
#if LOOK == 0
  const float wrap = 0.15, through = 0.20, gloss = 0.05, usual_albedo = 0.4;
#else
  const float wrap = 0.35, through = 0.1, gloss = 0.02, usual_albedo = 0.6;
#endif
#if LOOK == 2
  return vec3(strain_shade(n));
#else
  return exposure * (diffuse_light(n, wrap, through) + highlight(n, position, gloss) / usual_albedo);
#endif
}

void light_both_sides() {
  vec3 n = normalize(normal);
  face_light = as_factor(light_on(n));
#if LOOK == 0
  back_light = as_factor(back_of_cloth * light_on(-n));
#elif LOOK == 1
  back_light = as_factor(back_of_sheet * light_on(-n));
#else
  back_light = as_factor(light_on(-n));
#endif
}

#else

out vec3 world;
out vec3 world_normal;

#endif

out float particle_strain;
out vec2 grid;

void main() {
#ifdef QUICK
  light_both_sides();
#else
  world = position;
  world_normal = normal;
#endif
  particle_strain = strain;
  grid = cell;
  gl_Position = world_to_clip * vec4(position, 1.0);
}
