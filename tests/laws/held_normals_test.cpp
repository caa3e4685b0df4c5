// Steps of implicit methods in air whose equations are not solved: they are taken with air along the normals
// of their beginning.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/builtin_scenes.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::held_normals_test {
namespace {

Scene windy_sheet() {
  Scene scene = bare_sheet(6, 5);
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = SpringMaterial{.structural = 50, .shear = 20, .flexion = 10, .damping = 0.01};
  scene.gravity = Vec3(0, -9.81, 0);
  scene.air = Air{.drag = 0.02, .skin_friction = 0.005, .wind = {1, -0.5, 3}, .gust = {}};
  return scene;
}

Vec3Field end_of(const std::string& method, double step, bool hold) {
  constexpr double duration = 0.16;
  DirectRun run(windy_sheet(), method);
  const int steps = static_cast<int>(std::lround(duration / step));
  for (int n = 0; n < steps; ++n) {
    run.forces.update(run.state.position, run.state.time);
    run.forces.hold_normals(hold);
    run.advance(1, step);
    run.forces.hold_normals(false);
  }
  return run.state.position;
}

TEST(HeldNormals, LeaveImplicitEulerOfOrderOne) {
  const Vec3Field exact = end_of("rk4", 1e-4, false);
  double before = 0;
  for (const double step : {0.008, 0.004, 0.002}) {
    const Vec3Field held = end_of("implicit-euler", step, true);
    const double error = largest_distance(held, exact);
    EXPECT_GT(largest_distance(held, end_of("implicit-euler", step, false)), 0.01 * error) << step;
    if (before > 0) {
      EXPECT_NEAR(std::log2(before / error), 1, 0.25) << step;
    }
    before = error;
  }
}

// Without them the flag stops in the 35th step.
TEST(HeldNormals, CarryTheFlagThroughStepsThatNothingElseSolvesAndAreCounted) {
  Scene scene = builtin_scene("flag");
  scene.integrator = {"implicit-euler", 1.0 / 60};
  Simulation simulation(scene);
  for (int n = 0; n < 45; ++n) {
    const auto stop = simulation.step();
    ASSERT_FALSE(stop) << describe(*stop);
  }
  EXPECT_GT(simulation.count().held_normals, 0);
  EXPECT_LT(simulation.count().held_normals, 5);
  EXPECT_NE(describe(simulation.count())
                .find("which nothing else solved, air acted along the cloth's normals at their beginning"),
            std::string::npos);
}

TEST(HeldNormals, AreNeededNowhereInAWeakWind) {
  Scene scene = windy_sheet();
  scene.integrator = {"implicit-euler", 1.0 / 60};
  Simulation simulation(scene);
  for (int n = 0; n < 30; ++n) ASSERT_FALSE(simulation.step());
  EXPECT_EQ(simulation.count().held_normals, 0);
  EXPECT_EQ(describe(simulation.count()), "");
}

}  // namespace
}  // namespace cloth::test::held_normals_test
