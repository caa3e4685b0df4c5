// The predicted limits hold in practice: a stiff hanging 8x8 cloth just below and just above them, and the
// limit of pinned cloths at rest measured by bisection.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "measure/energy.h"
#include "measure/spectrum.h"
#include "measure/stability_limit.h"
#include "simulation/simulation.h"
#include "support/direct_run.h"
#include "support/reference.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::stability_test {
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

/// A flat cloth of `size` x `size` particles at rest, hung by its upper corners, without gravity.
Scene cloth_at_rest(int size, const SpringMaterial& material) {
  Scene scene = bare_sheet(size, size, 0.1, 0.002);
  scene.cloth.pins = {NamedPin::top_left, NamedPin::top_right};
  scene.springs = material;
  return scene;
}

/// Whether steps of this length make a tiny random motion grow within 200 periods of the fastest mode: its
/// energy passes what it had at first plus a thousandth of that of every spring at double length. A stable
/// step close to the limit lends the fastest mode up to 1 / (1 - omega h / 2) of its energy: the motion is
/// 1e-11 of that scale.
bool grows(const Scene& scene, const std::string& method, double step, double omega) {
  constexpr double spacing = 0.1;
  Random random;
  DirectRun run(scene, method);
  for (std::size_t i = 0; i < run.state.velocity.size(); ++i)
    if (!run.system.pinned[i]) run.state.velocity.set(i, random.vector(1e-6 * omega * spacing));
  const double scale = 0.5 * scene.springs->structural * spacing * spacing * run.system.size();
  const double most = measure_energy(run.system, Vec3::Zero(), run.state).total() + 1e-3 * scale;
  const double duration = 200 * 2 * std::numbers::pi / omega;
  while (static_cast<double>(run.state.step) * step < duration) {
    run.advance(20, step);
    if (!(measure_energy(run.system, Vec3::Zero(), run.state).total() <= most)) return true;
  }
  return false;
}

/// Between 0.9 and 1.1 of `predicted`, to 0.02 %.
double measured_limit(const Scene& scene, const std::string& method, double predicted, double omega) {
  double stable = 0.9 * predicted, unstable = 1.1 * predicted;
  EXPECT_FALSE(grows(scene, method, stable, omega)) << method;
  EXPECT_TRUE(grows(scene, method, unstable, omega)) << method;
  for (int halving = 0; halving < 9; ++halving) {
    const double middle = 0.5 * (stable + unstable);
    (grows(scene, method, middle, omega) ? unstable : stable) = middle;
  }
  return 0.5 * (stable + unstable);
}

TEST_P(StabilityLimit, MeasuredIsTheOneOfTheSystemsOwnSpectrum) {
  struct Case {
    int size;
    SpringMaterial material;
  };
  const SpringMaterial equal{.structural = 2000, .shear = 2000, .flexion = 2000, .damping = 0};
  const SpringMaterial soft{.structural = 2000, .shear = 1000, .flexion = 500, .damping = 0};
  const SpringMaterial weak{.structural = 2000, .shear = 200, .flexion = 20, .damping = 0};
  for (const Case& c : {Case{4, equal}, Case{4, soft}, Case{4, weak}, Case{8, equal}, Case{8, soft},
                        Case{8, weak}, Case{20, equal}, Case{20, weak}, Case{64, equal}, Case{64, soft}}) {
    const Scene scene = cloth_at_rest(c.size, c.material);
    const DirectRun at_rest(scene, GetParam());
    const double omega = measure_spectrum(at_rest.system, at_rest.system.start).largest_frequency();
    const double predicted = oscillator_limit(GetParam(), omega, 0);
    const double measured = measured_limit(scene, GetParam(), predicted, omega);
    const double closed_form = stable_step(GetParam(), scene).value();
    std::printf("%2d x %2d, shear %4g: measured / own spectrum %.4f, / closed form %.4f\n", c.size, c.size,
                c.material.shear, measured / predicted, measured / closed_form);
    EXPECT_NEAR(measured, predicted, 0.005 * predicted) << c.size << " " << c.material.shear;
    EXPECT_GE(measured, 0.999 * closed_form) << c.size;  // the unbounded grid oscillates faster
    if (c.size >= 20) {
      EXPECT_LE(measured, 1.03 * closed_form) << c.size;
    }
  }
}

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
}  // namespace cloth::test::stability_test
