#include "support/scenes.h"

namespace cloth::test {

Scene bare_sheet(int rows, int columns, double spacing, double particle_mass) {
  Scene scene;
  scene.cloth.rows = rows;
  scene.cloth.columns = columns;
  scene.cloth.width = spacing * (columns - 1);
  scene.cloth.height = spacing * (rows - 1);
  scene.cloth.mass = particle_mass * rows * columns;
  scene.cloth.origin = Vec3::Zero();
  return scene;
}

Scene lying_sheet(int rows, int columns, double spacing, double particle_mass) {
  Scene scene = bare_sheet(rows, columns, spacing, particle_mass);
  scene.cloth.down = {0, 0, 1};
  return scene;
}

SpringMaterial only(SpringFamily family, double stiffness) {
  SpringMaterial material;
  if (family == SpringFamily::structural) material.structural = stiffness;
  if (family == SpringFamily::shear) material.shear = stiffness;
  if (family == SpringFamily::flexion) material.flexion = stiffness;
  return material;
}

Scene smooth_scene(int rows, int columns) {
  Scene scene = bare_sheet(rows, columns, 0.2);
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = SpringMaterial{.structural = 47, .shear = 23.5, .flexion = 11.75, .damping = 0};
  scene.damping = 0.01;
  scene.gravity = Vec3(0, -9.81, 0);
  scene.air = Air{.drag = 0.02, .wind = {0.5, 0, 2}, .gust = Gust{.amplitude = 0.5, .frequency = 1.3}};
  return scene;
}

Scene damped_smooth_scene(int rows, int columns) {
  Scene scene = smooth_scene(rows, columns);
  scene.springs->damping = 0.05;
  scene.air->skin_friction = 0.002;
  return scene;
}

}  // namespace cloth::test
