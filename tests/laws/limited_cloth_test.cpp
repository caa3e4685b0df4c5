// Provot's deformation rate on the cloths of the report's figure 2: 33x33, hung by two corners, 10 %.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "scene/builtin_scenes.h"
#include "simulation/simulation.h"
#include "simulation/time_step.h"
#include "support/states.h"

namespace cloth::test::limited_cloth_test {
namespace {

struct Row {
  double time, kinetic, strain, excess;
};

/// What limited springs do, row by row of the recording.
std::vector<Row> rows_of(const Scene& scene) {
  Simulation simulation(scene);
  const std::int64_t per_row = steps_per_row(scene.record.interval, simulation.time_step());
  const std::int64_t last = steps_to_cover(scene.duration, simulation.time_step());
  const bool shear = scene.deformation->springs.size() == 2;
  std::vector<Row> rows;
  for (std::int64_t n = 1; n <= last; ++n) {
    const auto divergence = simulation.step();
    EXPECT_FALSE(divergence) << describe(*divergence);
    if (divergence) break;
    if (n % per_row != 0) continue;
    const Measurement m = simulation.measure();
    rows.push_back(
        {m.time, m.energy.kinetic, shear ? m.strain.maximum() : m.strain.largest[0], m.limiter_excess});
  }
  return rows;
}

double largest_kinetic(const std::vector<Row>& rows, double from, double to) {
  double largest = 0;
  for (const Row& row : rows)
    if (row.time >= from && row.time <= to) largest = std::max(largest, row.kinetic);
  return largest;
}

class LimitedCloth : public ::testing::TestWithParam<const char*> {};

TEST_P(LimitedCloth, KeepsTenPercentWithinAThousandthAndComesToRest) {
  Scene scene = builtin_scene(GetParam());
  ASSERT_EQ(scene.deformation->rate, 0.1);
  scene.duration = 5;
  const std::vector<Row> rows = rows_of(scene);
  ASSERT_EQ(rows.size(), 500u);
  for (const Row& row : rows) {
    EXPECT_LE(row.strain, 0.1 + 1e-3) << "t = " << row.time;
    EXPECT_LE(row.excess, 1e-3) << "t = " << row.time;
  }
  const double falling = largest_kinetic(rows, 0, 1), late = largest_kinetic(rows, 4, 5);
  std::printf("%s: kinetic energy %.3g J while it falls, %.3g J at 3 to 4 s, %.3g J at 4 to 5 s\n",
              GetParam(), falling, largest_kinetic(rows, 3, 4), late);
  EXPECT_LE(late, 0.01 * falling);
  EXPECT_LE(late, 1.01 * largest_kinetic(rows, 3, 4) + 1e-9);  // no growth at rest
}

INSTANTIATE_TEST_SUITE_P(Of, LimitedCloth, ::testing::Values("corners-shear", "corners-structural"),
                         [](const auto& scene) {
                           std::string name = scene.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

/// The cloth of figure 2 with another rate and a tolerance that sweeps need hundreds of sweeps for.
Scene tightly_limited(double rate, const char* solver) {
  Scene scene = builtin_scene("corners-shear");
  scene.deformation->rate = rate;
  scene.deformation->tolerance = 1e-6;
  scene.deformation->solver = solver;
  return scene;
}

TEST(ADirectlyLimitedCloth, KeepsTenAndOnePercentWithinAMillionthWhileItFalls) {
  for (const auto& [rate, end] : {std::pair{0.1, 0.2}, std::pair{0.01, 0.1}}) {  // both taut by then
    Simulation simulation(tightly_limited(rate, "direct"));
    std::int64_t iterations = 0;
    while (simulation.time() < end) {
      ASSERT_FALSE(simulation.step());
      const LimiterReport& report = simulation.last_limit();
      EXPECT_LE(report.excess, 1e-6) << "t = " << simulation.time();
      EXPECT_LE(report.direct_iterations, 25) << "t = " << simulation.time();
      EXPECT_EQ(report.sweeps, 0);
      iterations += report.direct_iterations;
    }
    EXPECT_GT(iterations, 0) << rate;
    EXPECT_LE(simulation.measure().strain.maximum(), rate + 1e-6 + 1e-12);
  }
}

TEST(ADirectlyLimitedCloth, MovesAsOneThatSweepsHaveLimitedToTheSameTolerance) {
  Simulation direct(tightly_limited(0.01, "direct"));
  Scene patient = tightly_limited(0.01, "sweeps");
  patient.deformation->max_sweeps = 100000;
  Simulation swept(patient);
  while (direct.time() < 0.05) {
    ASSERT_FALSE(direct.step());
    ASSERT_FALSE(swept.step());
  }
  const double travelled = largest_distance(direct.system().start, direct.state().position);
  EXPECT_LT(direct.measure().ledger.limiter, 0);  // it acted, and took energy
  EXPECT_GT(travelled, 5e-3);
  EXPECT_LE(largest_distance(direct.state().position, swept.state().position), 0.01 * travelled);
}

TEST(AnUnlimitedCloth, StretchesBeyondTenPercentAtItsCorners) {  // why Provot limits: report, figure 2 (a)
  Scene scene = builtin_scene("corners-free");
  Simulation simulation(scene);
  double largest = 0;
  while (simulation.time() < 1) {
    ASSERT_FALSE(simulation.step());
    largest = std::max(largest, simulation.measure().strain.maximum());
  }
  EXPECT_GT(largest, 0.15);
}

}  // namespace
}  // namespace cloth::test::limited_cloth_test
