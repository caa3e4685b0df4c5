// Falling, known in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "integrators/registry.h"
#include "measure/stability_limit.h"
#include "support/direct_run.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::fall_test {
namespace {

constexpr double mass = 0.01, g = 9.81;

Scene falling_sheet(double spring_damping) {
  Scene scene = lying_sheet(6, 5, 0.1, mass);
  scene.springs = SpringMaterial{.structural = 100, .shear = 50, .flexion = 10, .damping = spring_damping};
  scene.gravity = Vec3(0, -g, 0);
  return scene;
}

/// How far a method falls in n steps of h beyond -g t^2/2: the sum of its own quadrature. Order 2 has none.
double extra_fall(const std::string& method, double t, double h) {
  if (facts_of(method).order > 1) return 0;
  return (method == "explicit-euler" ? 0.5 : -0.5) * g * t * h;  // the speed at the start, or at the end
}

/// Every particle has moved by the same vertical distance and nothing else.
void expect_parabola(const DirectRun& run, const std::string& method, double h, double tolerance) {
  const double t = run.state.time;
  const Vec3 fall(0, -0.5 * g * t * t + extra_fall(method, t, h), 0);
  for (std::size_t i = 0; i < run.state.position.size(); ++i) {
    ASSERT_LE((run.state.position[i] - run.system.start[i] - fall).norm(), tolerance) << method << " " << i;
    ASSERT_LE((run.state.velocity[i] - Vec3(0, -g * t, 0)).norm(), 100 * tolerance) << method << " " << i;
  }
}

TEST(FreeFall, IsTheParabolaWhateverTheSpringDamping) {
  for (const double damping : {0.0, 0.001, 0.01, 0.1}) {
    for (const std::string& method : integrator_names()) {
      Scene scene = falling_sheet(damping);
      scene.integrator = exactly(method);
      // Explicit Euler has no stable step here: rounding grows, so that it falls for a short time only.
      const bool euler = method == "explicit-euler";
      const double limit = stable_step(euler ? "semi-implicit-euler" : method, scene).value();
      const double h = std::min(0.5 * limit * (euler ? 0.01 : 1), 0.01);
      DirectRun run(scene, method);
      run.advance(euler ? 2000 : static_cast<int>(std::lround(0.5 / h)), h);
      expect_parabola(run, method, h, 1e-11);
    }
  }
}

TEST(FreeFall, IsTheParabolaForATiltedSheetToo) {
  for (const char* method : {"semi-implicit-euler", "verlet", "rk4"}) {
    Scene scene = falling_sheet(0.01);
    scene.cloth.across = {1, 1, 0.3}, scene.cloth.down = {-0.5, 1, 1};
    DirectRun run(scene, method);
    run.advance(1000, 5e-4);
    expect_parabola(run, method, 5e-4, 1e-11);
  }
}

TEST(FreeFall, KeepsASheetFlatToTheBit) {
  for (const char* method : {"semi-implicit-euler", "verlet", "rk4"}) {
    DirectRun run(falling_sheet(0.01), method);
    run.advance(1000, 5e-4);
    for (std::size_t i = 1; i < run.state.position.size(); ++i)
      ASSERT_EQ(run.state.position[i].y(), run.state.position[0].y());
  }
}

double fall_speed(double rate, double t) {
  return -g / rate * (1 - std::exp(-rate * t));
}

TEST(TerminalVelocity, OfViscousDampingIsTheWeightOverTheCoefficient) {
  Scene scene = falling_sheet(0);
  scene.damping = 0.05;  // 5 1/s
  DirectRun run(scene, "rk4");
  for (const double t : {0.5, 1.0, 4.0}) {
    run.advance(static_cast<int>(std::lround((t - run.state.time) / 1e-3)), 1e-3);
    for (std::size_t i = 0; i < run.state.velocity.size(); ++i)
      ASSERT_NEAR(run.state.velocity[i].y(), fall_speed(5, t), 1e-10);
  }
  EXPECT_NEAR(run.state.velocity[0].y(), -mass * g / 0.05, 1e-8);
}

TEST(TerminalVelocity, OfAFlatSheetAddsItsDragAndLeavesItFlat) {
  for (const auto& [method, tolerance] : std::map<std::string, double>{{"rk4", 1e-10}, {"verlet", 1e-5}}) {
    Scene scene = falling_sheet(0.01);
    scene.damping = 0.03;
    scene.air = Air{.drag = 0.05, .wind = Vec3::Zero(), .gust = std::nullopt};
    DirectRun run(scene, method);
    run.advance(1000, 1e-3);
    for (std::size_t i = 0; i < run.state.velocity.size(); ++i) {
      ASSERT_NEAR(run.state.velocity[i].y(), fall_speed(8, 1), tolerance) << method;
      ASSERT_NEAR(run.state.position[i].y(), run.state.position[0].y(), 1e-14) << method;
    }
  }
}

TEST(TerminalVelocity, OfAnUpwindIsShiftedByIt) {
  Scene scene = falling_sheet(0);
  scene.air = Air{.drag = 0.05, .wind = {0, 3, 0}, .gust = std::nullopt};
  DirectRun run(scene, "rk4");
  run.advance(8000, 1e-3);
  EXPECT_NEAR(run.state.velocity[7].y(), 3 - mass * g / 0.05, 1e-9);
}

}  // namespace
}  // namespace cloth::test::fall_test
