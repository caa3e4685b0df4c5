// Materials against exact solutions, protocol by protocol: what clothlab-cli validate promises.
#include "study/validation/validation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "study/validation/strip_bench.h"
#include "study/validation/validation_report.h"

namespace cloth::test::validation_test {
namespace {

class Validation : public testing::TestWithParam<std::string> {};

TEST_P(Validation, IsWithinOnePerCentAtTwentyCellsAndOfSecondOrderOrExactWhereThatIsPromised) {
  ASSERT_FALSE(validation_rows({GetParam()}).empty());
  ASSERT_TRUE(validate(validation_rows({GetParam()}), [&](const ValidationRow& row) {
    EXPECT_TRUE(row.failure.empty()) << name_of(row) << ": " << row.failure;
    ASSERT_EQ(row.grids.size(), validation_cells.size()) << name_of(row);
    if (row.promise == Promise::none) {
      for (std::size_t k = 1; k < row.grids.size(); ++k)
        EXPECT_LT(std::abs(row.grids[k].error), std::abs(row.grids[k - 1].error) / 2) << name_of(row);
      return;
    }
    if (row.promise == Promise::exact) {
      for (const ValidationValue& grid : row.grids) EXPECT_LT(std::abs(grid.error), 1e-9) << name_of(row);
    }
    EXPECT_LE(std::abs(row.grids[1].error), 0.01) << name_of(row);
    if (row.promise == Promise::second_order) {
      EXPECT_GE(row.order(), 1.8) << name_of(row);
      EXPECT_LE(row.order(), 2.2) << name_of(row);
    }
    EXPECT_TRUE(row.holds()) << name_of(row);
  }));
}

INSTANTIATE_TEST_SUITE_P(Protocols, Validation, testing::ValuesIn(exact_protocols()),
                         [](const auto& protocol) {
                           std::string name = protocol.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(ValidationRows, DoNotHoldWithALargeErrorAWrongOrderOrAFailure) {
  ValidationRow row;
  row.exact = 1;
  for (const int cells : validation_cells) row.grids.push_back({cells, 0, 0.8 / (cells * cells), 0});
  EXPECT_NEAR(row.order(), 2, 1e-12);
  EXPECT_TRUE(row.holds());
  ValidationRow first = row;
  for (ValidationValue& grid : first.grids) grid.error = 0.01 / grid.cells;
  EXPECT_NEAR(first.order(), 1, 1e-12);
  EXPECT_FALSE(first.holds());
  first.promise = Promise::error;
  EXPECT_TRUE(first.holds());
  ValidationRow far = row;
  for (ValidationValue& grid : far.grids) grid.error = -5.0 / (grid.cells * grid.cells);
  EXPECT_FALSE(far.holds());
  ValidationRow rounded = row;
  rounded.promise = Promise::exact;
  EXPECT_FALSE(rounded.holds()) << "an error that falls is one";
  for (ValidationValue& grid : rounded.grids) grid.error = 1e-13 * grid.cells;
  EXPECT_TRUE(rounded.holds());
  EXPECT_TRUE(std::isnan(rounded.order())) << "rounding has none";
  row.failure = "no rest";
  EXPECT_FALSE(row.holds());
}

ValidationRow task_named(const std::string& name) {
  for (const ValidationRow& task : strip_tasks())
    if (name_of(task) == name) return task;
  ADD_FAILURE() << name;
  return {};
}

TEST(StripScore, OfTheExactCurveIsZeroAndOfOneMovedAsideTheMove) {
  const ValidationRow task = task_named("cantilever-5");
  std::vector<Eigen::Vector2d> points, aside;
  for (int k = 0; k <= 40; ++k) {
    points.push_back(point_at(task.curve, k / 40.0));
    aside.push_back(points.back() + Eigen::Vector2d(0, 0.01));
  }
  const StripScore exact = score_strip(task, points);
  EXPECT_LT(exact.largest, 1e-6);
  ASSERT_TRUE(exact.value);
  EXPECT_NEAR(*exact.value, task.exact, 1e-6);
  std::reverse(points.begin(), points.end());
  EXPECT_NEAR(*score_strip(task, points).value, task.exact, 1e-6) << "in any order";
  const StripScore moved = score_strip(task, aside);
  EXPECT_GT(moved.largest, 0.009);
  EXPECT_LE(moved.largest, 0.01 + 1e-9);
}

TEST(StripScore, IsRefusedWhereThePointsLeaveOutMuchOfTheCurve) {
  const ValidationRow task = task_named("pear-loop-20");
  std::vector<Eigen::Vector2d> half;
  for (int k = 0; k <= 20; ++k) half.push_back(point_at(task.curve, k / 40.0));
  EXPECT_FALSE(score_strip(task, half).failure.empty());
  EXPECT_FALSE(score_strip(task, {}).failure.empty());
}

TEST(StripScore, LeavesOutWhatIsBehindAClamp) {
  const ValidationRow task = task_named("hanging-wrinkle-5");
  std::vector<Eigen::Vector2d> points{point_at(task.curve, -0.05)};
  for (int k = 0; k <= 20; ++k) points.push_back(point_at(task.curve, k / 20.0));
  const StripScore score = score_strip(task, points);
  EXPECT_EQ(score.points, 21u);
  EXPECT_LT(score.largest, 1e-6);
}

}  // namespace
}  // namespace cloth::test::validation_test
