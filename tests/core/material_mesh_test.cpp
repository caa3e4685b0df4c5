// A material on triangle meshes: triangles of constant strain.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <set>

#include "cloth/mesh_cloth.h"
#include "measure/energy.h"
#include "measure/spectrum.h"
#include "measure/stability_limit.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "scene/scene_json.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/material_meshes.h"
#include "support/materials.h"
#include "support/states.h"

namespace cloth::test::material_mesh_test {
namespace {

constexpr double width = 0.6, height = 0.4;  // m

Material meshed_material() {
  Material m = any_material();
  m.coupling = 130;
  return m;
}

/// The particles that no edge of one triangle alone ends at.
std::vector<bool> are_inside(const ClothSystem& system) {
  std::multiset<std::pair<int, int>> edges;
  for (const Triangle& t : system.triangles)
    for (std::size_t e = 0; e < 3; ++e) edges.insert(std::minmax({t[e], t[(e + 1) % 3]}));
  std::vector<bool> inside(system.mass.size(), true);
  for (const auto& edge : edges)
    if (edges.count(edge) == 1) inside[at(edge.first)] = inside[at(edge.second)] = false;
  return inside;
}

/// St. Venant and Kirchhoff's energy of an area whose deformation gradient is everywhere the same, warp along
/// y.
double energy_density(const Material& m, const Eigen::Matrix3d& gradient) {
  const Eigen::Matrix3d e = 0.5 * (gradient.transpose() * gradient - Eigen::Matrix3d::Identity());
  return 0.5 * m.stretch_weft * e(0, 0) * e(0, 0) + 0.5 * m.stretch_warp * e(1, 1) * e(1, 1) +
         coupling_of(m) * e(0, 0) * e(1, 1) + 2 * m.shear * e(0, 1) * e(0, 1);
}

Eigen::Matrix3d large_gradient() {
  Eigen::Matrix3d f;
  f << 1.1, 0.25, 0, -0.15, 0.9, 0, 0, 0, 1;
  return Eigen::AngleAxisd(0.9, Vec3(1, -2, 1).normalized()).toRotationMatrix() * f;
}

TEST(MaterialMesh, StoresTheEnergyOfEveryAffineDeformationOnEveryMeshExactly) {
  Random random;
  const Material m = meshed_material();
  for (const Scene& scene : meshes_of_a_sheet(width, height, m, random)) {
    const ClothSystem system = make_cloth(scene);
    const double expected = width * height * energy_density(m, large_gradient());
    EXPECT_NEAR(elastic_energy_of(system, mapped(system.start, large_gradient())), expected,
                1e-10 * expected);
  }
}

TEST(MaterialMesh, OfAutomaticCouplingHasTheSmallStrainsOfAGridOfTheSameMaterial) {
  Random random;
  const Material m = any_material();
  const Scene mesh = material_mesh_sheet(9, 9, width, height, 0.3, m, random);
  const Scene grid = material_sheet(9, 9, width / 8, height / 8, m);
  const ClothSystem of_mesh = make_cloth(mesh), of_grid = make_cloth(grid);
  constexpr double small = 1e-5;
  for (const Vec3& strain : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(2, -1, 1)}) {
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f(0, 0) += small * strain.x(), f(1, 1) += small * strain.y(), f(0, 1) += small * strain.z();
    const double expected = elastic_energy_of(of_grid, mapped(of_grid.start, f));
    EXPECT_NEAR(elastic_energy_of(of_mesh, mapped(of_mesh.start, f)), expected, 1e-4 * expected);
  }
}

TEST(MaterialMesh, IsInEquilibriumInsideInEveryAffineDeformation) {
  Random random;
  Material m = meshed_material();
  m.bending_warp = m.bending_weft = m.twist = 0;
  for (const Scene& scene : meshes_of_a_sheet(width, height, m, random)) {
    const ClothSystem system = make_cloth(scene);
    const Vec3Field force = force_of(scene, mapped(system.start, large_gradient()));
    const std::vector<bool> inside = are_inside(system);
    for (std::size_t i = 0; i < force.size(); ++i) {
      if (!inside[i]) continue;
      EXPECT_LE(force[i].norm(), 1e-11 * largest_norm(force)) << i;
    }
  }
}

TEST(MaterialMesh, HasTheMassOfItsArea) {
  Random random;
  for (const Scene& scene : meshes_of_a_sheet(width, height, any_material(), random)) {
    const ClothSystem system = make_cloth(scene);
    EXPECT_NEAR(system.total_mass(), 0.18 * width * height, 1e-14);
    EXPECT_NEAR(particle_mass(scene) * system.size(), 0.18 * width * height, 1e-14);
  }
}

TEST(MaterialMesh, ForceIsMinusTheSlopeOfItsEnergyInAnyShape) {
  Random random;
  for (Scene& scene : meshes_of_a_sheet(width, height, meshed_material(), random)) {
    scene.cloth.down = Vec3(0.3, -0.5, 0), scene.cloth.across = Vec3(0.5, 0.3, 0);
    const ClothSystem system = make_cloth(scene);
    const Vec3Field position = crumpled_state(system, 0.02, 0, random).position;
    const Vec3Field force = force_of(scene, position);
    for (int n = 0; n < 5; ++n) {
      const Vec3Field direction = random.field(position.size(), 1);
      constexpr double shift = 1e-6;
      Vec3Field ahead = position, behind = position;
      add_scaled(shift, direction, ahead), add_scaled(-shift, direction, behind);
      const double slope =
          (elastic_energy_of(system, ahead) - elastic_energy_of(system, behind)) / (2 * shift);
      double expected = 0;
      for (std::size_t i = 0; i < force.size(); ++i) expected -= force[i].dot(direction[i]);
      EXPECT_NEAR(slope, expected, 1e-6 * largest_norm(force) * std::sqrt(double(force.size())));
    }
  }
}

TEST(MaterialMesh, DoesNotResistMovingAndTurning) {
  Random random;
  for (const Scene& scene : meshes_of_a_sheet(width, height, any_material(), random)) {
    const ClothSystem system = make_cloth(scene);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Vec3(2, 1, -1).normalized()).toRotationMatrix();
    EXPECT_LE(elastic_energy_of(system, mapped(system.start, turn)), 1e-20);
    const Vec3Field bent = crumpled_state(system, 0.01, 0, random).position;
    const double energy = elastic_energy_of(system, bent);
    EXPECT_NEAR(elastic_energy_of(system, mapped(bent, turn)), energy, 1e-11 * energy);
  }
}

// ---- motion ----

/// Held by its upper corners and moving in every way that a material can.
Scene moving_mesh(Random& random) {
  Material m = meshed_material();
  m.stretch_damping = 2e-4, m.bending_damping = 1e-3, m.mass_damping = 0.5;
  m.drag_normal = 0.8, m.drag_tangential = 0.1;
  Scene scene = material_mesh_sheet(7, 6, 0.3, 0.25, 0.2, m, random);
  scene.cloth.pins = {PinnedParticle{0, 0}, PinnedParticle{0, 6}};
  scene.gravity = Vec3(0, -6, 7);
  scene.air = Air{.wind = {0.5, 0.2, 2}, .gust = std::nullopt};
  scene.duration = 0.2;
  scene.record.interval = 0.02;
  return scene;
}

TEST(MaterialMesh, AnswersTheSameByEveryMethodAsStepsShrink) {
  Random random;
  expect_the_same_by_every_method(moving_mesh(random));
}

TEST(MaterialMesh, AccountsForItsEnergyAndKeepsItsMomentum) {
  Random random;
  Scene scene = moving_mesh(random);
  scene.integrator = {"rk4", 5e-5};
  Simulation run(scene);
  double exchanged = 0;
  while (run.time() < scene.duration - 1e-9) {
    ASSERT_FALSE(run.advance(50));
    exchanged = std::max(exchanged, run.measure().energy.kinetic);
    EXPECT_LE(std::abs(run.measure().energy_error()), 1e-6 * exchanged);
  }
  EXPECT_GT(run.measure().ledger.forces.damping_loss, 1e-3 * exchanged);

  scene = material_mesh_sheet(7, 6, 0.3, 0.25, 0.2, meshed_material(), random);
  DirectRun free(scene, exactly("rk4", 1e-4));
  free.state = crumpled_state(free.system, 0.003, 0.5, random);
  const Vec3 before = momentum(free.system, free.state), turning = angular_momentum(free.system, free.state);
  free.advance(200, 1e-4);
  EXPECT_LE((momentum(free.system, free.state) - before).norm(), 1e-12 * (1 + before.norm()));
  // RK4 keeps it to its own order alone.
  const double scale = free.system.total_mass() * 0.3 * 0.5;
  EXPECT_LE((angular_momentum(free.system, free.state) - turning).norm(), 1e-5 * scale);
}

// ---- stability ----

TEST(MaterialMesh, HasNoFrequencyAboveTheBoundAsLongAsNoEdgeIsStretchedBeyondWhatItCovers) {
  Random random;
  for (Scene& scene : meshes_of_a_sheet(width, height, meshed_material(), random)) {
    scene.cloth.pins = {PinnedParticle{0, 0}};
    const ClothSystem system = make_cloth(scene);
    const double bound = guaranteed_frequency(scene);
    EXPECT_LE(measure_spectrum(system, system.start).largest_frequency(), bound);
    EXPECT_LE(largest_frequency(scene), bound);
    for (const double stretch : {0.9, 1.0, covered_stretch}) {
      const Vec3Field position = mapped(system.start, stretch * Eigen::Matrix3d::Identity());
      EXPECT_LE(measure_spectrum(system, position).largest_frequency(), bound) << stretch;
    }
  }
}

// ---- the block ----

std::string rule_of(const Scene& scene, const std::string& path) {
  for (const Problem& problem : find_problems(scene))
    if (problem.path == path) return problem.rule;
  return "";
}

TEST(MaterialMesh, TakesEveryCouplingThatCostsEnergyAndAGridOnlyThatOfItsSprings) {
  Random random;
  Material m = any_material();
  m.stretch_warp = 25, m.stretch_weft = 6.5, m.shear = 8.8;  // navy-sparkle-sweat
  Scene mesh = material_mesh_sheet(4, 3, width, height, 0.2, m, random);
  EXPECT_EQ(rule_of(mesh, "material.shear"), "");
  Scene grid = material_sheet(5, 5, 0.1, 0.1, m);
  EXPECT_NE(rule_of(grid, "material.shear"), "");
  mesh.material->shear = 14;
  EXPECT_NE(rule_of(mesh, "material.shear"), "") << "the automatic coupling is beyond the root of 25 x 6.5";
  mesh.material->coupling = 5;
  EXPECT_EQ(rule_of(mesh, "material.shear"), "");
  mesh.material->coupling = 13;
  EXPECT_NE(rule_of(mesh, "material.coupling"), "");
  grid.material = any_material();
  grid.material->coupling = 20;
  EXPECT_NE(rule_of(grid, "material.coupling"), "");
  grid.material->coupling = grid.material->shear;
  EXPECT_EQ(rule_of(grid, "material.coupling"), "");
}

TEST(MaterialMesh, HasDirectionsInItsFileAndOneOfSpringsHasNone) {
  const auto with = [](const std::string& holds, const std::string& directions) {
    return read_scene(R"({"format": "clothlab/scene/1", "cloth": {"mesh": "disc.obj")" + directions + "}, " +
                          holds + R"(, "integrator": {"method": "verlet", "time_step": "auto"}, "duration": 1,
                      "record": {"interval": 0.01}})",
                      "test");
  };
  const std::string turned = R"(, "across": [0, 0, 1], "down": [1, 0, 0])";
  const auto material = with(R"("material": "gray-interlock")", turned);
  ASSERT_TRUE(material.scene.has_value());
  EXPECT_EQ(material.scene->cloth.down, Vec3(1, 0, 0));
  const auto again = read_scene(write_scene(*material.scene), "test");
  ASSERT_TRUE(again.scene.has_value());
  EXPECT_EQ(again.scene->cloth.down, Vec3(1, 0, 0));
  const auto springs = with(R"("springs": {"structural": 100})", turned);
  ASSERT_EQ(springs.problems.size(), 2u);
  EXPECT_EQ(springs.problems[0].path, "cloth.across");
  EXPECT_EQ(springs.problems[1].path, "cloth.down");
}

}  // namespace
}  // namespace cloth::test::material_mesh_test
