// The predicted limits hold in practice: a stiff hanging 8x8 cloth just below and just above them.
#include <gtest/gtest.h>

#include <cmath>

#include "measure/energy.h"
#include "measure/stability_limit.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test {
namespace {

Scene stiff_hanging_cloth(double damping) {
  Scene scene = bare_sheet(8, 8, 0.1, 0.002);
  scene.cloth.pins = {NamedPin::top_edge};
  scene.springs = SpringMaterial{.structural = 2000, .shear = 1000, .flexion = 500, .damping = 0};
  if (damping > 0) scene.damping = damping;
  scene.gravity = Vec3(0, -9.81, 0);
  return scene;
}

/// The largest kinetic energy of 5000 steps of `step`, from rest but for a disturbance of some micrometres a
/// second.
double largest_kinetic(const Scene& scene, const std::string& method, double step) {
  Random random;
  DirectRun run(scene, method);
  for (std::size_t i = 0; i < run.state.velocity.size(); ++i)
    if (!run.system.pinned[i]) run.state.velocity.set(i, random.vector(1e-6));
  double largest = 0;
  for (int n = 0; n < 500 && std::isfinite(largest); ++n) {
    run.advance(10, step);
    largest = std::max(largest, kinetic_energy(run.system, run.state.velocity));
    if (!(largest < 1e3)) return infinity;
  }
  return largest;
}

/// All that gravity can give: the whole cloth falling by its sag, generously a thousandth of its height.
constexpr double energy_scale = 64 * 0.002 * 9.81 * 0.8 * 0.01;

class StabilityLimit : public ::testing::TestWithParam<const char*> {};

TEST_P(StabilityLimit, OfTheGridAtRestIsSharpToThreePercent) {
  for (const double damping : {0.0, 0.05}) {
    const Scene scene = stiff_hanging_cloth(damping);
    const DirectRun at_rest(scene, GetParam());
    const double omega = largest_eigenfrequency(at_rest.system, at_rest.system.start);
    const double limit = oscillator_limit(GetParam(), omega, damping / 0.002);
    EXPECT_LE(largest_kinetic(scene, GetParam(), 0.97 * limit), energy_scale) << damping;
    EXPECT_EQ(largest_kinetic(scene, GetParam(), 1.03 * limit), infinity) << damping;
  }
}

TEST_P(StabilityLimit, OfTheSceneIsSafeForTheFiniteGrid) {
  const Scene scene = stiff_hanging_cloth(0);
  EXPECT_LE(largest_kinetic(scene, GetParam(), 0.99 * stable_step(GetParam(), scene).value()), energy_scale);
}

INSTANTIATE_TEST_SUITE_P(Of, StabilityLimit, ::testing::Values("semi-implicit-euler", "verlet"),
                         [](const auto& m) {
                           return std::string(m.param) == "verlet" ? "verlet" : "semi_implicit_euler";
                         });

TEST(ProvotsCriterion, IsUnstableOnAGrid) {
  const Scene scene = stiff_hanging_cloth(0);
  EXPECT_EQ(largest_kinetic(scene, "semi-implicit-euler", 0.9 * provot_step(scene)), infinity);
}

TEST(ExplicitEuler, WithoutDampingBlowsUpAtEveryStepInTheEnd) {
  const Scene scene = stiff_hanging_cloth(0);
  const double limit = stable_step("verlet", scene).value();
  for (const double fraction : {0.5, 0.2, 0.1})
    EXPECT_EQ(largest_kinetic(scene, "explicit-euler", fraction * limit), infinity) << fraction;
}

TEST(Rk4, IsStableJustBelowItsLimit) {
  const Scene scene = stiff_hanging_cloth(0.01);
  EXPECT_LE(largest_kinetic(scene, "rk4", 0.97 * stable_step("rk4", scene).value()), energy_scale);
}

}  // namespace
}  // namespace cloth::test
