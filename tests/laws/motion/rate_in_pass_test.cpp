// Verlet with damping that is not solved for while a deformation rate holds springs: the fused pass against
// the general method, the ledger, and the damping of single particles that it needs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cloth/grid.h"
#include "forces/damping_at.h"
#include "integrators/fused_steppers.h"
#include "limiter/step_limiter.h"
#include "measure/stability_limit.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_cloth.h"
#include "simulation/simulation.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::rate_in_pass_test {
namespace {

/// A sheet that falls into its pins, in wind, beyond a small rate.
Scene taut_scene() {
  Scene scene = damped_smooth_scene(6, 6);
  scene.cloth.rows = 17, scene.cloth.columns = 21;
  scene.deformation = Deformation{.rate = 0.02, .tolerance = 1e-7};
  return scene;
}

struct LimitedRun {
  ClothState state;
  StepLimiter limiter;
  Work work;
  double limiter_work = 0;
  int held = 0, few = 0;  ///< steps that began with tensions, and with few

  LimitedRun(const Scene& scene, const ClothSystem& system, Integrator& method)
      : state(starting_state(system)), limiter(*scene.deformation, system, false) {
    method.set_drift_constraint(&limiter);
  }
  void step(Integrator& method, ForceModel& forces, const StepTimes& times) {
    held += limiter.holds() ? 1 : 0, few += limiter.holds() && limiter.holds_few() ? 1 : 0;
    limiter.begin_step(times.step, state, false);
    method.step(forces, times, state, work);
    limiter.end_step(state);
    limiter_work += limiter.work().value_or(0);
  }
};

void expect_same_in_the_pass(EndVelocity end) {
  const Scene scene = taut_scene();
  const ClothSystem system = make_cloth(scene);
  ForceModel forces(scene, system), others(scene, system);
  ASSERT_TRUE(FusedDampedVerlet::suits(forces));
  ASSERT_TRUE(DampingAt::suits(system, forces.swept()));
  FusedDampedVerlet fused(end);
  Verlet general(end);
  LimitedRun a(scene, system, fused), b(scene, system, general);
  const double h = 0.1 / guaranteed_frequency(scene);
  for (int n = 0; n < 800; ++n) {
    const StepTimes times{n * h, (n + 1) * h, h};
    a.step(fused, forces, times);
    b.step(general, others, times);
  }
  ASSERT_GT(a.few, 100) << a.held;
  ASSERT_GT(a.held - a.few, 20);
  EXPECT_EQ(a.held, b.held);
  // Tensions are solved for to a tolerance.
  EXPECT_LT(rms_distance(a.state.position, b.state.position), 1e-6);
  EXPECT_NEAR(a.limiter_work, b.limiter_work, 1e-3 * std::abs(b.limiter_work));
  EXPECT_NEAR(a.work.air, b.work.air, 1e-5 * std::abs(b.work.air));
  EXPECT_NEAR(a.work.damping_loss, b.work.damping_loss, 1e-6 * b.work.damping_loss);
}

TEST(RateInThePass, IsTheSameInThePassAndInTheGeneralMethodWhereTheRateHoldsSprings) {
  for (const EndVelocity end :
       {EndVelocity::predicted, EndVelocity::corrected, EndVelocity::corrected_twice}) {
    SCOPED_TRACE(static_cast<int>(end));
    expect_same_in_the_pass(end);
  }
}

/// The balance of energy closes as well with the damping of single particles: its error falls with h^2.
TEST(RateInThePass, LeavesAnErrorInTheLedgerOfOrderTwoWhereTheRateHoldsSprings) {
  Scene scene = builtin_scene("flag");
  scene.duration = 0.5;
  std::vector<double> errors;
  for (const double h : {0.0002, 0.0001}) {
    scene.integrator.time_step = h;
    Simulation simulation(scene);
    ASSERT_FALSE(simulation.advance(static_cast<std::int64_t>(std::lround(0.48 / h))));
    ASSERT_LT(simulation.measure().ledger.limiter, -0.01);
    errors.push_back(std::abs(simulation.measure().energy_error()));
  }
  EXPECT_LT(errors[1], errors[0] / 3);
}

TEST(DampingAt, IsWhatTheForcesOfAllParticlesAreLessWithAVelocityThanWithout) {
  Random random;
  Scene narrow = damped_smooth_scene(6, 6);
  narrow.cloth.rows = 7, narrow.cloth.columns = 2;
  for (const Scene& scene :
       {damped_smooth_scene(6, 6), narrow, builtin_scene("flag"), builtin_scene("wind")}) {
    const ClothSystem system = make_cloth(scene);
    ForceModel forces(scene, system);
    ASSERT_TRUE(DampingAt::suits(system, forces.swept())) << scene.title;
    const ClothState state = crumpled_state(system, 0.01, 0.3, random);
    Vec3Field moving(state.position.size()), resting = moving;
    forces.update(state.position, 0.3);
    forces.force(state.position, state.velocity, moving);
    forces.force(state.position, Vec3Field(state.position.size()), resting);
    const double largest = std::max(largest_distance(moving, resting), 1e-12);
    const DampingAt damping(system, forces.swept());
    SparseField change;
    change.clear(state.position.size());
    double expected = 0;
    for (std::size_t i = 0; i < state.position.size(); ++i) {
      const Vec3 product = damping.product(i, state.position, state.velocity);
      ASSERT_LE((resting[i] - moving[i] - product).norm(), 1e-12 * largest) << scene.title << " " << i;
      if (i % 7 == 0) change.add(i, random.vector(1)), expected -= product.dot(change[i]);
    }
    EXPECT_NEAR(damping.power(state.position, state.velocity, change), expected,
                1e-12 * (largest * static_cast<double>(change.size())));
  }
}

TEST(DampingAt, IsNotKnownOfMeshesMaterialsAndDampingTimes) {
  for (const char* name : {"wind-denim", "disc"}) {
    const Scene scene = builtin_scene(name);
    const ClothSystem system = make_cloth(scene);
    const ForceModel forces(scene, system);
    EXPECT_FALSE(DampingAt::suits(system, forces.swept())) << name;
  }
}

}  // namespace
}  // namespace cloth::test::rate_in_pass_test
