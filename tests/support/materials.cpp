#include "support/materials.h"

#include <gtest/gtest.h>

#include <cmath>

#include "measure/energy.h"
#include "scene/scene_cloth.h"
#include "support/direct_run.h"
#include "support/reference.h"
#include "support/scenes.h"

namespace cloth::test {

Material any_material() {
  return {.areal_density = 0.18,
          .stretch_warp = 500,
          .stretch_weft = 400,
          .shear = 60,
          .bending_warp = 3e-3,
          .bending_weft = 2e-3,
          .twist = 1.5e-3};
}

Material material_with_hysteresis() {
  Material m = any_material();
  m.hysteresis_warp = m.hysteresis_weft = 0.02;
  return m;
}

Scene material_sheet(int rows, int columns, double across, double down, const Material& material) {
  Scene scene = bare_sheet(rows, columns);
  scene.cloth.width = across * (columns - 1);
  scene.cloth.height = down * (rows - 1);
  scene.material = material;
  return scene;
}

Scene complete_material_scene() {
  Material m = any_material();
  m.stretch_damping = 2e-4, m.bending_damping = 1e-3, m.mass_damping = 0.5;
  m.drag_normal = 0.8, m.drag_tangential = 0.1;
  Scene scene = material_sheet(7, 9, 0.05, 0.04, m);
  scene.cloth.down = Vec3(0, -0.6, 0.8);
  scene.cloth.pins = {NamedPin::top_edge};  // and the next row: it bends at a clamp
  for (int column = 0; column < 9; ++column) scene.cloth.pins.emplace_back(PinnedParticle{1, column});
  scene.gravity = Vec3(0, -9.81, 0);
  scene.air = Air{.wind = {0.5, 0.2, 2}, .gust = std::nullopt};
  scene.duration = 0.2;
  scene.record.interval = 0.02;
  return scene;
}

std::vector<Scene> grids_of_a_sheet(const Material& material) {
  std::vector<Scene> scenes;
  for (const auto& [rows, columns] : {std::pair{3, 4}, {5, 7}, {9, 7}, {7, 13}, {9, 13}})
    scenes.push_back(material_sheet(rows, columns, 0.6 / (columns - 1), 0.4 / (rows - 1), material));
  return scenes;
}

Vec3Field mapped(const Vec3Field& from, const Eigen::Matrix3d& by) {
  Vec3Field to(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) to.set(i, by * from[i]);
  return to;
}

double elastic_energy_of(const ClothSystem& system, const Vec3Field& position) {
  const ClothState state{.position = position, .velocity = Vec3Field(position.size())};
  return measure_energy(system, Vec3::Zero(), state).elastic;
}

Vec3Field force_of(const Scene& scene, const Vec3Field& position) {
  const ClothSystem system = make_cloth(scene);
  ForceModel forces(scene, system);
  Vec3Field force(position.size());
  forces.update(position, 0);
  forces.force(position, Vec3Field(position.size()), force);
  return force;
}

void expect_the_same_by_every_method(const Scene& scene) {
  const auto end_by = [&](const std::string& method, double step) {
    DirectRun run(scene, exactly(method, step));
    run.advance(static_cast<int>(std::lround(0.04 / step)), step);
    return run.state.position;
  };
  const Vec3Field exact = end_by("rk4", 1e-5);
  for (const auto& [method, step, order] : {std::tuple{"semi-implicit-euler", 8e-5, 1},
                                            {"verlet", 1e-4, 2},
                                            {"implicit-euler", 1e-4, 1},
                                            {"implicit-midpoint", 2e-4, 2},
                                            {"bdf2", 2e-4, 2},
                                            {"projective", 1e-4, 1},
                                            {"xpbd", 1e-4, 1},
                                            {"vbd", 1e-4, 1}}) {
    const double coarse = rms_distance(end_by(method, step), exact),
                 fine = rms_distance(end_by(method, step / 2), exact);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.25) << method;
    EXPECT_LE(coarse, 2e-3) << method;
  }
}

Eigen::MatrixXd bending_hessian(const ClothSystem& system) {
  const Eigen::Index size = 3 * system.size();
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
  for (const BendingRun& run : system.bending)
    for (int e = run.first; e < run.first + run.count; ++e)
      for (std::size_t p = 0; p < static_cast<std::size_t>(run.points); ++p)
        for (std::size_t q = 0; q < static_cast<std::size_t>(run.points); ++q)
          for (int axis = 0; axis < 3; ++axis)
            hessian(3 * (e + run.offset[p]) + axis, 3 * (e + run.offset[q]) + axis) +=
                run.stiffness * run.coefficient[p] * run.coefficient[q];
  return hessian;
}

}  // namespace cloth::test
