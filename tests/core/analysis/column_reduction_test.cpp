// Numbers from the columns of a record.
#include "study/column_reduction.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace cloth::test::column_reduction_test {
namespace {

const std::vector<double> time{0, 1, 3}, values{2, 4, -1};
constexpr double none = std::numeric_limits<double>::quiet_NaN();

TEST(ColumnReduction, IsTheLastTheLargestTheSmallestOrTheMeanOverTime) {
  EXPECT_EQ(reduced(time, values, ColumnReduction::final), -1);
  EXPECT_EQ(reduced(time, values, ColumnReduction::max), 4);
  EXPECT_EQ(reduced(time, values, ColumnReduction::min), -1);
  EXPECT_EQ(*reduced(time, values, ColumnReduction::mean), (3.0 * 1 + 1.5 * 2) / 3);
  EXPECT_EQ(reduced(std::vector{2.0}, std::vector{7.0}, ColumnReduction::mean), 7);
}

TEST(ColumnReduction, HasNoValueWhereOneThatCountsIsNone) {
  EXPECT_FALSE(reduced({}, {}, ColumnReduction::final));
  const std::vector<double> gap{2, none, 5}, end{2, 5, none};
  EXPECT_EQ(reduced(time, gap, ColumnReduction::final), 5);
  for (const ColumnReduction over : {ColumnReduction::max, ColumnReduction::min, ColumnReduction::mean})
    EXPECT_FALSE(reduced(time, gap, over));
  EXPECT_FALSE(reduced(time, end, ColumnReduction::final));
}

TEST(ColumnReduction, HasTheNamesOfItsKinds) {
  for (const ColumnReduction over : {ColumnReduction::final, ColumnReduction::max, ColumnReduction::min, ColumnReduction::mean})
    EXPECT_EQ(column_reduction_named(name_of(over)), over);
  EXPECT_FALSE(column_reduction_named("median"));
}

TEST(ValueAt, IsOnTheLineBetweenTheRowsAround) {
  EXPECT_EQ(value_at(time, values, 0.5), 3);
  EXPECT_EQ(value_at(time, values, 2), 1.5);
  EXPECT_EQ(value_at(time, values, 1), 4);
  EXPECT_EQ(value_at(time, values, -1), 2);
  EXPECT_EQ(value_at(time, values, 9), -1);
  EXPECT_FALSE(value_at({}, {}, 1));
}

}  // namespace
}  // namespace cloth::test::column_reduction_test
