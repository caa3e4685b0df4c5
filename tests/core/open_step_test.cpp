// A step whose velocities wait for contact.
#include <gtest/gtest.h>

#include <cmath>

#include "integrators/verlet.h"
#include "scene/builtin_scenes.h"
#include "simulation/simulation.h"
#include "support/scenes.h"

namespace cloth::test::open_step_test {
namespace {

struct Setting {
  explicit Setting(const std::string& name)
      : scene(builtin_scene(name)), simulation(scene), forces(scene, simulation.system()) {
    state = simulation.state();
    for (std::size_t i = 0; i < state.velocity.size(); ++i)
      if (!simulation.system().pinned[i])
        state.velocity.set(i, {0.1 * std::sin(1.0 * double(i)), 0.2, 0.1 * std::cos(3.0 * double(i))});
  }
  StepTimes times(int step) const { return {1e-4 * step, 1e-4 * (step + 1), 1e-4}; }

  Scene scene;
  Simulation simulation;
  ForceModel forces;
  ClothState state;
  Verlet verlet;
  Work work;
};

TEST(AVerletStep, OpenedAndThenClosedIsTheSameStepToTheBit) {
  for (const char* name : {"fold", "slope"}) {
    Setting whole(name), halves(name);
    ASSERT_TRUE(halves.verlet.waits_for_contact(halves.forces)) << name;
    for (int step = 0; step < 5; ++step) {
      const auto one = whole.verlet.step(whole.forces, whole.times(step), whole.state, whole.work);
      auto two = halves.verlet.open_step(halves.forces, halves.times(step), halves.state, halves.work);
      halves.verlet.close_step(halves.forces, halves.times(step), halves.state, halves.work, two);
      EXPECT_EQ(one.force_evaluations, two.force_evaluations);
      EXPECT_EQ(one.velocity_iterations, two.velocity_iterations);
    }
    EXPECT_TRUE(whole.state.position == halves.state.position) << name;
    EXPECT_TRUE(whole.state.velocity == halves.state.velocity) << name;
    EXPECT_EQ(whole.work.damping_loss, halves.work.damping_loss) << name;
    EXPECT_GT(whole.work.damping_loss, 0) << name << ": nothing was damped";
  }
}

/// Contact that leaves the positions where they are, after a whole step and after an open one.
TEST(AVerletStep, LeftOpenBooksTheSameWorkAfterContactAsAClosedOne) {
  Setting closed("fold"), open("fold");
  for (int step = 0; step < 3; ++step)
    for (Setting* one : {&closed, &open}) {
      const Vec3Field before = one->state.position;
      const StepTimes times = one->times(step);
      if (one == &closed)
        one->verlet.step(one->forces, times, one->state, one->work);
      else
        one->verlet.open_step(one->forces, times, one->state, one->work);
      Vec3Field half(before.size());
      for (std::size_t i = 0; i < before.size(); ++i)
        half.set(i, (one->state.position[i] - before[i]) / times.step);
      one->verlet.update_velocity_for_positions(one->forces, times, half, one->state);
      one->verlet.update_velocity_for_damping(one->forces, times, half, one->state);
      one->work += one->verlet.correct_work(one->forces, times, one->state);
    }
  EXPECT_TRUE(closed.state.position == open.state.position);
  EXPECT_TRUE(closed.state.velocity == open.state.velocity);
  EXPECT_GT(closed.work.damping_loss, 0);
  EXPECT_NEAR(open.work.damping_loss, closed.work.damping_loss, 1e-12 * std::abs(closed.work.damping_loss));
}

/// The pass of a grid keeps no force for an open step where something damps: it must take whole steps.
TEST(AVerletStep, OfAGridWithViscousDampingAndSelfContactFallsByItsRecurrence) {
  constexpr double h = 0.001, c = 0.02, mass = 0.01, g = 9.81;
  Scene scene = lying_sheet(8, 8, 0.1, mass);
  scene.springs = SpringMaterial{.structural = 20, .shear = 10, .flexion = 5};
  scene.damping = c;
  scene.gravity = Vec3(0, -g, 0);
  scene.self_contact = SelfContact{};
  scene.integrator = {"verlet", h};
  Simulation simulation(scene);
  double v = 0;
  for (int n = 0; n < 50; ++n) {
    ASSERT_FALSE(simulation.step());
    v = ((1 - 0.5 * h * c / mass) * v - h * g) / (1 + 0.5 * h * c / mass);
    for (std::size_t i = 0; i < 64; ++i)
      ASSERT_NEAR(simulation.state().velocity[i].y(), v, 1e-12 * std::abs(v)) << n << " " << i;
  }
}

}  // namespace
}  // namespace cloth::test::open_step_test
