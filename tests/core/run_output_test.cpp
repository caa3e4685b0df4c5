// Reductions by hand, measures of a shape by hand, and contours.
#include "study/run_output.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scenes.h"
#include "sweep/contour.h"

namespace cloth::test::run_output_test {
namespace {

/// Of the values 1, 4, 2, 3 at the times 0, 1, 2, 4.
double reduced(const RunOutput& output) {
  OutputReducer reducer(output);
  const double times[] = {0, 1, 2, 4}, values[] = {1, 4, 2, 3};
  for (int k = 0; k < 4; ++k) reducer.add(times[k], values[k]);
  return reducer.result();
}

TEST(Reduction, IsTheOneByHand) {
  EXPECT_EQ(reduced({.reduce = Reduction::final_value}), 3);
  EXPECT_EQ(reduced({.reduce = Reduction::maximum}), 4);
  EXPECT_EQ(reduced({.reduce = Reduction::minimum}), 1);
  EXPECT_EQ(reduced({.reduce = Reduction::mean}), (2.5 + 3 + 5) / 4);
  EXPECT_EQ(reduced({.reduce = Reduction::first_above, .bound = 2.5}), 0.5);
  EXPECT_EQ(reduced({.reduce = Reduction::first_above, .bound = 0.5}), 0);
  EXPECT_EQ(reduced({.reduce = Reduction::first_below, .from = 1, .bound = 3}), 1.5);
  EXPECT_TRUE(std::isnan(reduced({.reduce = Reduction::first_above, .bound = 5})));
  EXPECT_EQ(reduced({.reduce = Reduction::stays_below, .bound = 3.5}), 1.25);
  EXPECT_EQ(reduced({.reduce = Reduction::stays_below, .bound = 5}), 0);
}

TEST(Reduction, StaysBelowOnlyIfTheValueDoesNotComeBack) {
  const auto time_to_rest = [](std::vector<double> values) {
    OutputReducer reducer({.reduce = Reduction::stays_below, .bound = 1});
    for (std::size_t k = 0; k < values.size(); ++k) reducer.add(static_cast<double>(k), values[k]);
    return reducer.result();
  };
  EXPECT_EQ(time_to_rest({2, 0, 2, 0, 0.5}), 2.5) << "not 0.5, where it first was below";
  EXPECT_TRUE(std::isnan(time_to_rest({2, 0, 2}))) << "it ends above";
  EXPECT_TRUE(std::isnan(time_to_rest({2, 1}))) << "the bound itself is not below it";
}

TEST(ParseOutput, KnowsItsEndingsAndLeavesTheRest) {
  EXPECT_EQ(parse_output("elastic_J").reduce, Reduction::final_value);
  for (const auto& [text, reduction] : {std::pair{"probe.tip.x_m:max", Reduction::maximum},
                                        {"probe.tip.x_m:min", Reduction::minimum},
                                        {"probe.tip.x_m:mean", Reduction::mean}}) {
    EXPECT_EQ(parse_output(text).of, "probe.tip.x_m");
    EXPECT_EQ(parse_output(text).reduce, reduction);
  }
  EXPECT_EQ(parse_output("max_strain:median").of, "max_strain:median") << "no ending: an unknown source";
}
TEST(Reduction, LooksAtItsWindowAlone) {
  EXPECT_EQ(reduced({.reduce = Reduction::final_value, .from = 0, .to = 2}), 2);
  EXPECT_EQ(reduced({.reduce = Reduction::maximum, .from = 2, .to = 9}), 3);
  EXPECT_EQ(reduced({.reduce = Reduction::mean, .from = 2, .to = 9}), 2.5);
  EXPECT_EQ(reduced({.reduce = Reduction::mean, .from = 4, .to = 4}), 3);
  EXPECT_TRUE(std::isnan(reduced({.reduce = Reduction::mean, .from = 5, .to = 9})));
}

TEST(Reduction, ToAMeasuredCurveIsTheRootMeanSquareAtItsTimes) {
  RunOutput output{.reduce = Reduction::rms};
  output.measured = {.times = {0, 0.5, 3}, .values = {1, 2.5, 2.5}};
  EXPECT_EQ(reduced(output), 0) << "the curve lies on the lines between rows";
  output.measured.values = {1, 2.5, 5.5};
  EXPECT_DOUBLE_EQ(reduced(output), std::sqrt(9.0 / 3));
  output.measured.times.back() = 4.1;
  EXPECT_TRUE(std::isnan(reduced(output))) << "the run ended before the curve";
}

TEST(Reduction, DoesNotLoseAValueThatIsNoNumber) {
  const RunOutput output{.reduce = Reduction::maximum};
  OutputReducer reducer(output);
  for (const double value : {1.0, std::nan(""), 0.5}) reducer.add(0, value);
  EXPECT_TRUE(std::isnan(reducer.result()));
}

TEST(ShapeMeasures, OfAHangingSheetAreItsSizes) {
  Scene scene = bare_sheet(4, 6);  // 0.5 m by 0.3 m down from the origin
  scene.cloth.pins = {NamedPin::top_left};
  scene.gravity = Vec3(0, -9.81, 0);
  scene.integrator.time_step = 1e-3;
  const Simulation simulation(scene);
  const auto value = [&](const std::string& name) {
    return output_values({name}, simulation, simulation.measure()).front();
  };
  EXPECT_NEAR(value("lowest_point"), -0.3, 1e-12);
  EXPECT_NEAR(value("sag"), 0.3, 1e-12);
  EXPECT_NEAR(value("extent_x"), 0.5, 1e-12);
  EXPECT_NEAR(value("extent_y"), 0.3, 1e-12);
  EXPECT_NEAR(value("extent_z"), 0, 1e-12);
  EXPECT_NEAR(value("extent"), 0.5, 1e-12);
  EXPECT_EQ(value("time_s"), 0);
  EXPECT_TRUE(std::isnan(value("no_such_column")));
}

TEST(ContourLines, OfAPlaneAreStraightAndOfAHillClosed) {
  const std::vector<double> x{0, 1, 2, 3}, y{0, 2, 3};
  std::vector<double> plane, hill;
  for (const double v : y)
    for (const double u : x) plane.push_back(u + 2 * v);
  const auto lines = contour_lines(x, y, plane, 3.5);
  ASSERT_EQ(lines.size(), 1u);
  for (const auto& [u, v] : lines[0]) EXPECT_NEAR(u + 2 * v, 3.5, 1e-12);
  std::vector<double> grid;
  for (int k = -10; k <= 10; ++k) grid.push_back(0.1 * k);
  for (const double v : grid)
    for (const double u : grid) hill.push_back(u * u + v * v);
  const auto circle = contour_lines(grid, grid, hill, 0.5);
  ASSERT_EQ(circle.size(), 1u);
  EXPECT_EQ(circle[0].front(), circle[0].back());
  for (const auto& [u, v] : circle[0]) EXPECT_NEAR(std::hypot(u, v), std::sqrt(0.5), 0.003);
}

TEST(ContourLines, KeepAwayFromWhatIsNoNumber) {
  const std::vector<double> x{0, 1, 2}, y{0, 1};
  const double none = std::nan("");
  EXPECT_TRUE(contour_lines(x, y, std::vector<double>{0, none, 1, 0, 1, 1}, 0.5).empty());
  EXPECT_EQ(contour_lines(x, y, std::vector<double>{0, 1, none, 0, 1, 1}, 0.5).size(), 1u);
}

}  // namespace
}  // namespace cloth::test::run_output_test
