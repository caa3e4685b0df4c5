// Where a cloth comes to rest, known in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/direct_run.h"
#include "support/scenes.h"
#include "support/states.h"

namespace cloth::test::equilibrium_test {
namespace {

constexpr double spacing = 0.1, mass = 0.01, stiffness = 20, g = 9.81;

/// Damping that brings a chain of `links` to rest fast: near critical for its slowest motion.
double damping_for(int links) {
  const double slowest = 2 * std::sqrt(stiffness / mass) * std::sin(std::numbers::pi / (2 * (2 * links + 1)));
  return 1.6 * mass * slowest;
}

void settle(DirectRun& run) {
  run.advance(60000, 5e-4);
  ASSERT_LE(largest_norm(run.state.velocity), 1e-12);
}

class HangingChain : public ::testing::TestWithParam<const char*> {};

TEST_P(HangingChain, StretchesEachSpringByTheWeightBelowIt) {
  constexpr int links = 10;
  Scene scene = bare_sheet(links + 1, 2, spacing, mass);  // two chains side by side
  scene.cloth.pins = {NamedPin::top_edge};
  scene.springs = only(SpringFamily::structural, stiffness);
  scene.gravity = Vec3(0, -g, 0);
  scene.damping = damping_for(links);
  DirectRun run(scene, GetParam());
  settle(run);
  for (const std::size_t column : {0u, 1u}) {
    for (int i = 1; i <= links; ++i) {
      const auto upper = static_cast<std::size_t>(2 * (i - 1)) + column;
      const double length = (run.state.position[upper + 2] - run.state.position[upper]).norm();
      EXPECT_NEAR(length, spacing + (links - i + 1) * mass * g / stiffness, 1e-11) << i;
    }
    const double tip = -(links * spacing + mass * g * links * (links + 1) / (2 * stiffness));
    EXPECT_NEAR(run.state.position[2 * links + column].y(), tip, 1e-10);
    const double tension =
        stiffness * ((run.state.position[2 + column] - run.state.position[column]).norm() - spacing);
    EXPECT_NEAR(tension, links * mass * g, 1e-10);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, HangingChain, ::testing::Values("verlet", "rk4"),
                         [](const auto& method) { return std::string(method.param); });

/// Half the span of a chain of N springs between level ends that pulls with H: sum (L + T/k) H/T.
double span_at(double pull, int springs) {
  double span = 0;
  for (int i = 0; i < springs; ++i) {
    const double vertical = mass * g * (0.5 * (springs - 1) - i), tension = std::hypot(pull, vertical);
    span += (spacing + tension / stiffness) * pull / tension;
  }
  return span;
}

double pull_for(double span, int springs) {
  double low = 0, high = 100;
  for (int halving = 0; halving < 200; ++halving) {
    const double middle = 0.5 * (low + high);
    (span_at(middle, springs) < span ? low : high) = middle;
  }
  return low;
}

TEST(ElasticCatenary, IsTheShapeOfAStripBetweenLevelEnds) {
  constexpr int springs = 12;
  Scene scene = lying_sheet(2, springs + 1, spacing, mass);  // two rows that sag alike
  scene.cloth.pins = {NamedPin::left_edge, NamedPin::right_edge};
  scene.springs = only(SpringFamily::structural, stiffness);
  scene.gravity = Vec3(0, -g, 0);
  scene.damping = damping_for(springs);
  DirectRun run(scene, "verlet");
  settle(run);
  const double pull = pull_for(springs * spacing, springs);
  Vec3 node = run.state.position[0];
  for (std::size_t i = 0; i < springs; ++i) {
    const double vertical = mass * g * (0.5 * (springs - 1) - static_cast<double>(i));
    const double tension = std::hypot(pull, vertical);
    node += (spacing + tension / stiffness) / tension * Vec3(pull, -vertical, 0);
    EXPECT_LE((run.state.position[i + 1] - node).norm(), 1e-9) << i;
    EXPECT_LE((run.state.position[i + 2 + springs] - node - Vec3(0, 0, spacing)).norm(), 1e-9) << i;
  }
}

}  // namespace
}  // namespace cloth::test::equilibrium_test
