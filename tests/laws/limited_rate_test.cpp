// The deformation rate is kept within its tolerance on every step, by every method; a run that does not keep
// it says so.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "integrators/registry.h"
#include "scene/builtin_scenes.h"
#include "simulation/recorder.h"
#include "simulation/simulation.h"
#include "simulation/time_step.h"

namespace cloth::test::limited_rate_test {
namespace {

/// The built-in `wind` at the method's automatic step.
Scene gusty(const std::string& method, int side, double rate, double duration) {
  Scene scene = builtin_scene("wind");
  scene.cloth.rows = scene.cloth.columns = side;
  scene.deformation->rate = rate;
  scene.integrator = {.method = method};
  scene.integrator.time_step = resolved_time_step(scene).value();
  scene.duration = duration;
  return scene;
}

/// Steps on which the rate was at work.
int keep_rate(const Scene& scene) {
  Simulation simulation(scene);
  const Deformation& deformation = *scene.deformation;
  int taut = 0;
  while (simulation.time() < scene.duration) {
    const auto divergence = simulation.step();
    EXPECT_FALSE(divergence) << describe(*divergence);
    if (divergence) break;
    const Strain strain = measure_strain(simulation.system(), simulation.state().position);
    EXPECT_LE(strain.maximum(), deformation.rate + deformation.tolerance + 1e-12)
        << "step " << simulation.state().step;
    EXPECT_LE(simulation.last_limit().excess, deformation.tolerance);
    taut += simulation.last_limit().sweeps > 0 ? 1 : 0;
  }
  EXPECT_FALSE(simulation.rate_breach());
  return taut;
}

std::vector<std::string> methods() {
  std::vector<std::string> names = integrator_names();
  names.erase(std::remove(names.begin(), names.end(), "explicit-euler"), names.end());
  return names;
}

class EveryMethodThatLimits : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryMethodThatLimits, KeepsTenOneAndATenthOfAPercentOnEveryStep) {
  int taut = 0;
  for (const double rate : {0.1, 0.01, 0.001}) {
    SCOPED_TRACE(rate);
    taut += keep_rate(gusty(GetParam(), 17, rate, 0.3));
  }
  EXPECT_GT(taut, 10);
}

INSTANTIATE_TEST_SUITE_P(Of, EveryMethodThatLimits, ::testing::ValuesIn(methods()), [](const auto& method) {
  std::string name = method.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(ALimitedCloth, KeepsItsRateOnFinerGridsToo) {
  EXPECT_GT(keep_rate(gusty("verlet", 65, 0.001, 0.01)), 5);
  EXPECT_GT(keep_rate(gusty("xpbd", 49, 0.1, 0.1)), 2);
  EXPECT_GT(keep_rate(gusty("projective", 49, 0.1, 0.1)), 2);
}

/// Tensions are forces at both ends of the step: else a taut cloth would show half a kick of what they hold.
TEST(ALimitedCloth, HasNoSpeedWhereItHangsAtRest) {
  for (const char* method : {"verlet", "semi-implicit-euler"}) {
    Scene scene = builtin_scene("corners-shear");
    scene.cloth.rows = scene.cloth.columns = 9;
    scene.deformation->rate = 0.001;
    scene.damping = 0.02;  // about critical for a pendulum of this length
    scene.integrator = {.method = method};
    scene.integrator.time_step = resolved_time_step(scene).value();
    Simulation simulation(scene);
    double peak = 0;
    while (simulation.time() < 6) {
      ASSERT_FALSE(simulation.step());
      peak = std::max(peak, simulation.measure().energy.kinetic);
    }
    EXPECT_GT(simulation.measure().strain.maximum(), 0.00099) << "nothing is taut";
    EXPECT_LE(simulation.measure().energy.kinetic, 1e-4 * peak) << method;  // the tolerance lets it tremble
  }
}

Scene barely_limited() {
  Scene scene = builtin_scene("corners-shear");
  scene.deformation->rate = 0.001;
  scene.deformation->solver = "sweeps";
  scene.deformation->max_sweeps = 1;
  scene.duration = 0.1;
  return scene;
}

TEST(ARateThatIsNotKept, IsSaidWithStepSpringAndExcess) {
  const Scene scene = barely_limited();
  const RunResult result = run_scene(scene, {});
  ASSERT_EQ(result.summary.status, Status::finished);
  ASSERT_TRUE(result.summary.rate_breach);
  const RateBreach& breach = *result.summary.rate_breach;
  EXPECT_GT(breach.first_step, 0);
  EXPECT_GT(breach.first_excess, scene.deformation->tolerance);
  EXPECT_GE(breach.largest_excess, breach.first_excess);
  EXPECT_GE(breach.largest_excess, result.summary.limiter_excess);
  EXPECT_NE(breach.first_particle, breach.second_particle);
  EXPECT_NE(result.summary.notice.find("rate not kept: in step " + std::to_string(breach.first_step)),
            std::string::npos)
      << result.summary.notice;
}

/// Contact comes last: a spring that it stretches is beyond the rate all the same.
TEST(ARateThatIsNotKept, IsSaidAlsoWhereContactHasStretchedASpring) {
  for (const auto& [name, method] : {std::pair{"tablecloth", "verlet"}, {"cube", "semi-implicit-euler"}}) {
    SCOPED_TRACE(name);
    Scene scene = builtin_scene(name);
    scene.deformation->rate = 0.01;
    scene.integrator = {.method = method};
    scene.integrator.time_step = resolved_time_step(scene).value();
    Simulation simulation(scene);
    const double most = scene.deformation->rate + scene.deformation->tolerance;
    std::int64_t beyond = 0;
    while (simulation.time() < 0.4) {
      ASSERT_FALSE(simulation.step());
      const double strain = measure_strain(simulation.system(), simulation.state().position).maximum();
      beyond += strain > most ? 1 : 0;
      EXPECT_EQ(simulation.rate_breach() ? simulation.rate_breach()->steps : 0, beyond);
      EXPECT_NEAR(std::max(0.0, strain - scene.deformation->rate), simulation.last_limit().excess, 1e-12);
    }
    ASSERT_GT(beyond, 0);
    EXPECT_TRUE(simulation.rate_breach()->by_contact);
    EXPECT_NE(describe(*simulation.rate_breach()).find("contact has stretched it"), std::string::npos);
  }
}

TEST(ARateThatIsNotKept, IsForgottenWhereTheRunGoesBackToBeforeIt) {
  Simulation simulation(barely_limited());
  const Checkpoint start = simulation.checkpoint();
  while (!simulation.rate_breach()) ASSERT_FALSE(simulation.step());
  const Checkpoint later = simulation.checkpoint();
  simulation.restore(start);
  EXPECT_FALSE(simulation.rate_breach());
  simulation.restore(later);
  EXPECT_TRUE(simulation.rate_breach());
}

}  // namespace
}  // namespace cloth::test::limited_rate_test
