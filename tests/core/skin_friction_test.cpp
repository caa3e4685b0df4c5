// Tangential drag of the air, alone and beside the drag along the normal.

#include <gtest/gtest.h>

#include <cmath>

#include "forces/registry.h"
#include "integrators/registry.h"
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

TEST(SkinFriction, LetsNoExplicitMethodUseAFusedStepThatDoesNotKnowIt) {
  Scene scene = sheet_in_air(0.01, {1, 0, 0});
  scene.springs = SpringMaterial{.structural = 50, .shear = 20, .flexion = 2, .damping = 0};
  DirectRun run(scene, "rk4");
  ASSERT_TRUE(run.forces.sweeps_steps());
  EXPECT_FALSE(run.forces.is_swept_whole());
  EXPECT_FALSE(stepper_kind("verlet", run.forces, {}).fused);
  EXPECT_FALSE(stepper_kind("rk4", run.forces, {}).fused);
}

}  // namespace
}  // namespace cloth::test::skin_friction_test
