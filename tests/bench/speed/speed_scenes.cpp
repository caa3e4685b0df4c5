#include "bench/speed/speed_scenes.h"

#include <algorithm>
#include <cassert>

#include "scene/scene_cloth.h"
#include "simulation/time_step.h"

namespace cloth::speed {
namespace {

constexpr double viscous_damping = 0.001;  // N s/m

void add_damping(Scene& scene) {
  if (scene.material)
    scene.material->mass_damping = viscous_damping / particle_mass(scene);
  else
    scene.damping = viscous_damping;
}

/// As stiff and heavy as the bare cloth; bending is a medium cotton's.
void make_material(Scene& scene, bool bends) {
  scene.springs.reset();
  scene.material =
      Material{.areal_density = scene.cloth.mass, .stretch_warp = 950, .stretch_weft = 950, .shear = 250};
  if (bends) scene.material->bending_warp = scene.material->bending_weft = scene.material->twist = 2e-5;
}

void add_air(Scene& scene) {
  scene.air = Air{.drag = 0.002, .wind = {0, 0, 2}, .gust = std::nullopt};
}

void add_sphere(Scene& scene) {
  Obstacle sphere;
  sphere.center = {0, 0.5, -0.1};
  sphere.radius = 0.2;
  scene.obstacles.push_back(sphere);
}

/// Bilinear, at row `down` and column `across` of a square field with `size` columns.
Vec3 interpolated(const Vec3Field& field, int size, double down, double across) {
  const int row = std::min(static_cast<int>(down), size - 2);
  const int column = std::min(static_cast<int>(across), size - 2);
  const double s = down - row, t = across - column;
  const auto at = [&](int r, int c) { return field[static_cast<std::size_t>(r * size + c)]; };
  return (1 - s) * ((1 - t) * at(row, column) + t * at(row, column + 1)) +
         s * ((1 - t) * at(row + 1, column) + t * at(row + 1, column + 1));
}

}  // namespace

const std::vector<Feature>& features() {
  static const std::vector<Feature> list{
      {"bare", "", [](Scene&) {}},
      {"damping", "viscous damping", add_damping},
      {"air", "wind and normals", add_air},
      {"spring-damping", "spring damping", [](Scene& s) { s.springs->damping = 0.001; }},
      {"limit-10", "limit to 10 %", [](Scene& s) { s.deformation = Deformation{.rate = 0.1}; }},
      {"limit-1", "limit to 1 %", [](Scene& s) { s.deformation = Deformation{.rate = 0.01}; }},
      {"sphere", "a sphere", add_sphere},
      {"material", "a material", [](Scene& s) { make_material(s, false); }},
      {"bending", "a material that bends", [](Scene& s) { make_material(s, true); }},
  };
  return list;
}

const Feature& bare_feature() {
  return features().front();
}

const Feature& feature_named(const std::string& name) {
  const auto found = std::find_if(features().begin(), features().end(),
                                  [&](const Feature& feature) { return feature.name == name; });
  assert(found != features().end());
  return *found;
}

Scene hanging_cloth(int size, const std::string& method, const Feature& feature) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = size;
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = SpringMaterial{.structural = 500, .shear = 250, .flexion = 50};
  scene.gravity = Vec3(0, -9.81, 0);
  scene.integrator.method = method;
  feature.add(scene);
  if (!resolved_time_step(scene)) {
    Scene damped = scene;
    add_damping(damped);
    scene.integrator.time_step = resolved_time_step(damped);
  }
  return scene;
}

DevelopedCloth::DevelopedCloth(const Feature& feature) {
  Simulation simulation(hanging_cloth(size_, "verlet", feature));
  const auto steps = static_cast<int>(hanging_time / simulation.time_step());
  for (int k = 0; k < steps; ++k)
    if (simulation.step()) break;  // what diverges here will say so where it is timed
  state_ = simulation.state();
}

void DevelopedCloth::put_into(Simulation& simulation) const {
  const int size = simulation.system().columns;
  assert(size == simulation.system().rows && size >= 2);
  Checkpoint checkpoint = simulation.checkpoint();
  const double scale = (size_ - 1.0) / (size - 1.0);
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const auto i = static_cast<std::size_t>(simulation.system().index(row, column));
      checkpoint.state.position.set(i, interpolated(state_.position, size_, row * scale, column * scale));
      checkpoint.state.velocity.set(i, interpolated(state_.velocity, size_, row * scale, column * scale));
    }
  simulation.restore(checkpoint);
}

const DevelopedCloth& DevelopedCloths::of(const std::string& feature) {
  const auto found = made_.find(feature);
  if (found != made_.end()) return found->second;
  return made_.emplace(feature, DevelopedCloth(feature_named(feature))).first->second;
}

}  // namespace cloth::speed
