layout(location = 0) in vec3 position;  // m

uniform mat4 world_to_clip;

void main() {
  gl_Position = world_to_clip * vec4(position, 1.0);
  gl_Position.z -= 0.0005 * gl_Position.w;  // on the cloth, not in it
}
