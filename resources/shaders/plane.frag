// The ground or a plane obstacle: a faint grid that fades with distance over a barely tinted floor.
in vec2 on_plane;
in vec3 world;

uniform float reach;          // m
uniform float fade_from;      // share of the reach
uniform vec2 grid_offset;     // m: lines run through multiples of grid_step of the world
uniform float grid_step;      // m
uniform vec3 floor_colour;    // sRGB
uniform float floor_opacity;  // in the middle
uniform vec3 line_colour;     // sRGB
uniform float line_opacity;
uniform float line_width;  // px

out vec4 colour;

float lines(vec2 p, float step_size) {
  vec2 cell = p / step_size;
  vec2 per_pixel = max(fwidth(cell), vec2(1e-6));
  vec2 to_line = abs(fract(cell - 0.5) - 0.5) / per_pixel;
  vec2 line = 1.0 - smoothstep(0.5 * line_width - 0.5, 0.5 * line_width + 0.5, to_line);
  line = mix(line, min(line_width * per_pixel, 1.0), smoothstep(0.15, 0.4, per_pixel));
  return max(line.x, line.y);
}

void main() {
  float away = length(on_plane) / reach;
  float fade = 1.0 - smoothstep(fade_from, 1.0, away);
  vec2 p = on_plane + grid_offset;
  float line = line_opacity * max(0.55 * lines(p, grid_step), lines(p, 5.0 * grid_step));
  float opacity = fade * (floor_opacity + line * (1.0 - floor_opacity));
  colour = vec4(mix(floor_colour, line_colour, line / max(floor_opacity + line, 1e-4)), opacity);
}
