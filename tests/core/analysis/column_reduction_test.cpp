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
  EXPECT_EQ(reduced(time, values, Reduction::final), -1);
  EXPECT_EQ(reduced(time, values, Reduction::max), 4);
  EXPECT_EQ(reduced(time, values, Reduction::min), -1);
  EXPECT_EQ(*reduced(time, values, Reduction::mean), (3.0 * 1 + 1.5 * 2) / 3);
  EXPECT_EQ(reduced(std::vector{2.0}, std::vector{7.0}, Reduction::mean), 7);
}

TEST(ColumnReduction, HasNoValueWhereOneThatCountsIsNone) {
  EXPECT_FALSE(reduced({}, {}, Reduction::final));
  const std::vector<double> gap{2, none, 5}, end{2, 5, none};
  EXPECT_EQ(reduced(time, gap, Reduction::final), 5);
  for (const Reduction over : {Reduction::max, Reduction::min, Reduction::mean})
    EXPECT_FALSE(reduced(time, gap, over));
  EXPECT_FALSE(reduced(time, end, Reduction::final));
}

TEST(ColumnReduction, HasTheNamesOfItsKinds) {
  for (const Reduction over : {Reduction::final, Reduction::max, Reduction::min, Reduction::mean})
    EXPECT_EQ(reduction_named(name_of(over)), over);
  EXPECT_FALSE(reduction_named("median"));
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
