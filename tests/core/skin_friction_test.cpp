// Tangential drag of the air, alone and beside the drag along the normal.

#include <gtest/gtest.h>

#include <cmath>

#include "forces/registry.h"
#include "integrators/registry.h"
#include "integrators/verlet.h"
#include "measure/stability_limit.h"
#include "scene/builtin_scenes.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::skin_friction_test {
namespace {

constexpr double coefficient = 0.03;  // N s/m

Scene sheet_in_air(double drag, const Vec3& wind) {
  Scene scene = bare_sheet(3, 4);
  scene.air = Air{.drag = drag, .skin_friction = coefficient, .wind = wind, .gust = {}};
  return scene;
}

TEST(SkinFriction, OfAFlatClothIsThePartOfTheSpeedInItsPlane) {
  const Vec3 wind(1, 2, 3), velocity(0.5, -0.25, 4);
  DirectRun run(sheet_in_air(0, wind), "verlet");
  for (std::size_t i = 0; i < run.state.velocity.size(); ++i) run.state.velocity.set(i, velocity);
  Vec3Field force(run.state.position.size());
  run.forces.update(run.state.position, 0);
  run.forces.force(run.state.position, run.state.velocity, force);
  const Vec3 normal =
      (run.state.position[1] - run.state.position[0]).cross(run.state.position[4] - run.state.position[0]);
  const Vec3 n = normal.normalized(), w = wind - velocity;
  for (std::size_t i = 0; i < force.size(); ++i)
    EXPECT_LE((force[i] - coefficient * (w - n.dot(w) * n)).norm(), 1e-16) << i;
}

TEST(SkinFriction, WithTheSameDragAlongTheNormalIsViscousDampingInStillAir) {
  Random random;
  Scene viscous = bare_sheet(3, 4);
  viscous.damping = coefficient;
  DirectRun run(sheet_in_air(coefficient, Vec3::Zero()), "verlet"), same(viscous, "verlet");
  const ClothState state = crumpled_state(run.system, 0.04, 0.3, random);
  Vec3Field force(state.position.size()), expected(state.position.size());
  run.forces.update(state.position, 0);
  run.forces.force(state.position, state.velocity, force);
  same.forces.update(state.position, 0);
  same.forces.force(state.position, state.velocity, expected);
  EXPECT_LE(largest_distance(force, expected), 1e-15 * largest_norm(expected));
}

TEST(SkinFriction, HasTheExactJacobian) {
  Random random;
  DirectRun run(sheet_in_air(0, {1, -2, 3}), "implicit-euler");
  const ClothState state = crumpled_state(run.system, 0.04, 0.3, random);
  const Vec3Field u = crumpled_state(run.system, 0.04, 1, random).velocity;
  constexpr double shift = 1e-6;
  const auto force_at = [&](double by) {
    Vec3Field position = state.position, velocity = state.velocity, force(u.size());
    add_scaled(by, u, position);
    add_scaled(by, u, velocity);
    run.forces.update(position, 0);
    run.forces.force(position, velocity, force);
    return force;
  };
  const Vec3Field ahead = force_at(shift), behind = force_at(-shift);
  force_at(0);
  Linearisation linearisation;
  run.forces.linearise(state.position, {.position = 1, .velocity = 1, .clamped = false}, linearisation);
  Vec3Field product(u.size()), rest(u.size());
  linearisation.multiply_free(run.system, u, product);
  run.forces.asymmetric_product(state.position, state.velocity, u, rest);
  for (std::size_t i = 0; i < u.size(); ++i) {
    const Vec3 expected = run.system.mass[i] * u[i] - (ahead[i] - behind[i]) / (2 * shift);
    EXPECT_LE((product[i] + rest[i] - expected).norm(), 1e-8) << i;
  }
}

TEST(SkinFriction, BooksItsWorkAsThatOfTheAirWithEveryMethod) {
  for (const std::string& method : integrator_names()) {
    Scene scene = bare_sheet(5, 5);
    scene.springs = SpringMaterial{.structural = 50, .shear = 20, .flexion = 2, .damping = 0};
    scene.air = Air{.drag = 0, .skin_friction = 0.002, .wind = {3, 0.5, 1}, .gust = {}};
    scene.integrator = exactly(method, 1e-5);
    scene.integrator.tolerance = 1e-9;
    scene.duration = 0.05;
    Simulation simulation(scene);
    for (int n = 0; n < 5000; ++n) ASSERT_FALSE(simulation.step()) << method;
    const Measurement end = simulation.measure();
    EXPECT_GT(end.ledger.forces.air, 1e-4) << method;
    EXPECT_EQ(end.ledger.forces.damping_loss, 0) << method;
    EXPECT_LE(std::abs(end.energy_error()), 0.01 * end.ledger.forces.air) << method;
  }
}

std::unique_ptr<Integrator> general_method(const std::string& method) {
  if (method == "verlet") return std::make_unique<Verlet>(EndVelocity::predicted);
  return make_integrator(exactly(method));
}

/// Springs with skin friction alone and beside drag, and a material, whose particles have shares of the air.
std::vector<Scene> scenes_in_wind() {
  std::vector<Scene> scenes;
  for (const double drag : {0.0, 0.01}) {
    scenes.push_back(sheet_in_air(drag, {1, 0.5, -2}));
    scenes.back().air->gust = Gust{.amplitude = 0.5, .frequency = 2};
    scenes.back().springs = SpringMaterial{.structural = 50, .shear = 20, .flexion = 2, .damping = 0};
  }
  scenes.push_back(builtin_scene("wind-denim"));
  scenes.back().cloth.rows = 7, scenes.back().cloth.columns = 11;
  scenes.back().deformation.reset();
  return scenes;
}

TEST(SkinFriction, IsTheSameInThePassOfAGridAndInTheGeneralMethods) {
  for (const Scene& scene : scenes_in_wind())
    for (const std::string method : {"explicit-euler", "semi-implicit-euler", "verlet", "rk4"}) {
      DirectRun fused(scene, method), general(scene, method);
      fused.take_damping(EndVelocity::predicted);
      ASSERT_TRUE(stepper_kind(method, fused.forces, {.end_velocity = EndVelocity::predicted}).fused) << method;
      const double h = 0.02 / guaranteed_frequency(scene);
      fused.advance(100, h);
      const std::unique_ptr<Integrator> step = general_method(method);
      for (int n = 0; n < 100; ++n)
        step->step(general.forces, {n * h, (n + 1) * h, h}, general.state, general.work);
      EXPECT_LE(largest_distance(fused.state.position, general.state.position), 1e-13) << method;
      EXPECT_LE(largest_distance(fused.state.velocity, general.state.velocity), 1e-10) << method;
      EXPECT_NEAR(fused.work.air, general.work.air, 1e-9 * std::abs(general.work.air)) << method;
      EXPECT_NE(general.work.air, 0) << method;
    }
}

}  // namespace
}  // namespace cloth::test::skin_friction_test
