// A cloth that damping lets come to rest does so under contact, and then it lies still.
#include <gtest/gtest.h>

#include <utility>

#include "measure/stability_limit.h"
#include "simulation/simulation.h"
#include "simulation/time_step.h"
#include "support/contact_check.h"

namespace cloth::test::contact_rest_test {
namespace {

/// With damping that takes the energy of every oscillation within a fraction of a second.
Scene damped(Scene scene) {
  scene.damping = 0.004;
  for (Obstacle& obstacle : scene.obstacles) obstacle.friction = 0.6;
  scene.integrator = {.method = "verlet", .time_step = 0.001};
  return scene;
}

class ADampedScene : public ::testing::TestWithParam<std::string> {};

TEST_P(ADampedScene, ComesToRestWithinFiveSecondsAndLiesStill) {
  const Scene scene = damped(contact_scene(GetParam()));
  const double time = GetParam() == "cones" ? 2 : 5;  // s; the cones take long, and hold the cloth soon
  const RestingRun run = rest_run(scene, {.time = time, .watched = 1, .prepare = thrown({0, -1, 0})});
  ASSERT_FALSE(run.stop) << describe(*run.stop);
  EXPECT_GT(run.peak, 1e-3);
  EXPECT_LT(run.kinetic, 1e-6 * run.peak);
  EXPECT_LT(run.highest_after, 1e-6 * run.peak) << "it began to move again";
  const double still = GetParam() == "sphere" ? 2e-4 : 1e-4;  // m; on the ball it settles ever more slowly
  EXPECT_LT(run.furthest_after, still) << "it jitters or creeps";
  EXPECT_GT(run.touched, 0) << "it fell past";
}

TEST_P(ADampedScene, ComesToRestNearTheLongestStableStepToo) {
  Scene scene = damped(contact_scene(GetParam()));
  scene.integrator.time_step.reset();
  scene.integrator.time_step = resolved_time_step(scene).value();
  const RestingRun run = rest_run(scene, {.time = 5, .watched = 0.5, .prepare = thrown({0, -1, 0})});
  ASSERT_FALSE(run.stop) << describe(*run.stop);
  EXPECT_LT(run.kinetic, 1e-6 * run.peak);
  EXPECT_LT(run.highest_after, 1e-6 * run.peak) << "it began to move again";
}

/// Damping that is evaluated twice and three times in place of a solve, at what it is allowed for.
TEST_P(ADampedScene, ComesToRestWithStiffDampersNearTheLongestStableStepToo) {
  for (const auto& [end, load] : {std::pair{EndVelocity::corrected, largest_corrected_load},
                                  std::pair{EndVelocity::corrected_twice, largest_corrected_twice_load}}) {
    Scene scene = damped(contact_scene(GetParam()));
    scene.integrator.time_step.reset();
    scene.integrator.time_step = resolved_time_step(scene).value();
    const auto load_with = [&](double damping) {
      scene.springs->damping = damping;
      return damping_load(scene, *scene.integrator.time_step);
    };
    const double without = load_with(0);
    scene.springs->damping = 0.999 * (load - without) / (load_with(1) - without);
    EXPECT_EQ(Simulation(scene).stepper().end_velocity, end);
    const RestingRun run = rest_run(scene, {.time = 5, .watched = 0.5, .prepare = thrown({0, -1, 0})});
    ASSERT_FALSE(run.stop) << describe(*run.stop);
    EXPECT_LT(run.kinetic, 1e-6 * run.peak) << load;
    EXPECT_LT(run.highest_after, 1e-6 * run.peak) << load << ": it began to move again";
  }
}

/// Where two faces of the cloth share the tip of a box, and springs damp what is beside it.
TEST(AClothOnTheCornerOfABox, KeepsNoSpeedThatNoPositionFollows) {
  Scene scene = contact_scene("corner");
  scene.damping = 0.004;
  scene.integrator = {.method = "verlet"};
  scene.integrator.time_step = resolved_time_step(scene).value();
  const RestingRun run = rest_run(scene, {.time = 5, .watched = 0.5});
  ASSERT_FALSE(run.stop) << describe(*run.stop);
  EXPECT_LT(run.highest_after, 1e-8 * run.peak);
  EXPECT_LT(run.furthest_after, 1e-4);
  EXPECT_GT(run.touched, 0) << "it fell off";
}

INSTANTIATE_TEST_SUITE_P(Contact, ADampedScene,
                         ::testing::Values("sphere", "box", "plane", "cones", "itself"),
                         [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace cloth::test::contact_rest_test
