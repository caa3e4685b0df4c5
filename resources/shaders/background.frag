in float height;

uniform vec3 top, bottom;  // sRGB

out vec4 colour;

void main() {
  // Half a grey level of noise keeps a slow gradient from showing bands.
  float noise = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
  colour = vec4(mix(bottom, top, height) + noise / 255.0, 1.0);
}
