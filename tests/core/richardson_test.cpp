// Orders, limits and error bands of sequences whose order is known, and of those that have none.
#include "study/richardson.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace cloth::test::richardson_test {
namespace {

/// limit + factor cell^order, for each cell.
std::vector<GridValue> power_law(double limit, double factor, double order,
                                 const std::vector<double>& cells) {
  std::vector<GridValue> grids;
  for (const double cell : cells) grids.push_back({cell, limit + factor * std::pow(cell, order)});
  return grids;
}

const std::vector<std::vector<double>> refinements{
    {0.4, 0.2, 0.1, 0.05}, {0.3, 0.2, 0.12, 0.11}, {0.05, 0.049, 0.02, 0.001}, {1, 0.9, 0.81, 0.729}};

TEST(Richardson, FindsTheOrderOfAPowerLawWithAnyRatios) {
  for (const double order : {0.7, 1.0, 1.5, 2.0, 4.0})
    for (const double factor : {-3.0, 0.02})
      for (const auto& cells : refinements) {
        const auto grids = power_law(1.5, factor, order, cells);
        const Richardson found = richardson(grids, 10);
        EXPECT_EQ(found.verdict, GridVerdict::converging);
        ASSERT_EQ(found.orders.size(), 2u);
        for (const double seen : found.orders) EXPECT_NEAR(seen, order, 1e-4) << cells[0];
        EXPECT_NEAR(found.extrapolate, 1.5, 1e-6);
        EXPECT_NEAR(found.band, 1.25 * std::abs(grids.back().value - 1.5), 1e-6);
        EXPECT_NEAR(found.index, found.band / std::abs(grids.back().value), 1e-15);
        EXPECT_NEAR(found.range_ratio, 1, 1e-3);
        EXPECT_TRUE(found.is_asymptotic) << found.words;
      }
}

TEST(Richardson, OfThreeGridsHasOneOrderAndClaimsNoAsymptoticRange) {
  const Richardson found = richardson(power_law(2, 1, 2, {0.4, 0.2, 0.1}));
  EXPECT_NEAR(found.order, 2, 1e-12);
  EXPECT_NEAR(found.extrapolate, 2, 1e-12);
  EXPECT_FALSE(found.is_asymptotic);
  EXPECT_TRUE(std::isnan(found.range_ratio));
  EXPECT_NE(found.words.find("a fourth grid"), std::string::npos) << found.words;
}

TEST(Richardson, OfTwoGridsAssumesAnOrderAndTrebles) {
  const auto grids = power_law(2, 1, 2, {0.2, 0.1});
  const Richardson found = richardson(grids);
  EXPECT_EQ(found.verdict, GridVerdict::two_grids);
  EXPECT_EQ(found.order, 2);
  EXPECT_NEAR(found.extrapolate, 2, 1e-14);
  EXPECT_NEAR(found.band, 3 * 0.01, 1e-14);
  // Of order 1 instead of the assumed 2, the band still reaches the limit.
  const auto first_order = power_law(2, 1, 1, {0.2, 0.1});
  EXPECT_GE(richardson(first_order).band * (1 + 1e-12), first_order.back().value - 2);
}

TEST(Richardson, BelievesNoMoreThanTheFormalOrder) {
  const auto grids = power_law(1, 1, 6, {0.4, 0.2, 0.1});
  const Richardson found = richardson(grids, 2);
  EXPECT_NEAR(found.order, 6, 1e-6);
  EXPECT_NEAR(found.band, 1.25 * (grids[1].value - grids[2].value) / 3, 1e-12);
}

TEST(Richardson, ClaimsNoOrderOfWhatOscillates) {
  const Richardson shrinking = richardson({{0.4, 1.4}, {0.2, 0.8}, {0.1, 1.1}});
  EXPECT_EQ(shrinking.verdict, GridVerdict::oscillating);
  EXPECT_TRUE(std::isnan(shrinking.order) && std::isnan(shrinking.extrapolate) && std::isnan(shrinking.band));
  EXPECT_NE(shrinking.words.find("from 0.8 to 1.4"), std::string::npos) << shrinking.words;
  EXPECT_EQ(richardson({{0.4, 1.1}, {0.2, 0.8}, {0.1, 1.4}}).verdict, GridVerdict::diverging);
}

TEST(Richardson, ClaimsNoOrderOfWhatDiverges) {
  for (const double order : {-2.0, -0.5})
    for (const auto& cells : refinements) {
      const Richardson found = richardson(power_law(1, 1, order, cells));
      EXPECT_EQ(found.verdict, GridVerdict::diverging) << order;
      EXPECT_NEAR(found.orders.back(), order, 1e-4) << "seen, but not claimed";
      EXPECT_TRUE(std::isnan(found.order) && std::isnan(found.extrapolate) && std::isnan(found.index));
    }
  // As fast as a logarithm: the differences of halved cells are equal.
  EXPECT_EQ(richardson({{0.4, 1}, {0.2, 2}, {0.1, 3}}).verdict, GridVerdict::diverging);
  EXPECT_EQ(richardson({{0.4, 1}, {0.2, 1}, {0.1, 3}}).verdict, GridVerdict::diverging);
}

TEST(Richardson, JudgesByTheFinestThree) {
  auto grids = power_law(1, 1, 2, {0.4, 0.2, 0.1});
  grids.insert(grids.begin(), {0.8, 0.5});  // on the other side
  const Richardson found = richardson(grids);
  EXPECT_EQ(found.verdict, GridVerdict::converging);
  EXPECT_TRUE(std::isnan(found.orders.front()));
  EXPECT_FALSE(found.is_asymptotic) << found.words;
  EXPECT_NE(found.words.find("not yet"), std::string::npos) << found.words;
}

TEST(Richardson, OfAConstantIsTheConstant) {
  for (const double value : {0.0, 3.0, -1e-30}) {
    const Richardson found = richardson({{0.4, value}, {0.2, value}, {0.1, value}});
    EXPECT_EQ(found.verdict, GridVerdict::unchanged);
    EXPECT_EQ(found.extrapolate, value);
    EXPECT_TRUE(std::isnan(found.order));
    EXPECT_LT(found.band, 1e-12);
  }
  const double next = std::nextafter(3.0, 4.0);
  EXPECT_EQ(richardson({{0.4, 3}, {0.2, next}, {0.1, 3}}).verdict, GridVerdict::unchanged)
      << "but for rounding";
}

TEST(Richardson, OfFewerThanTwoGridsSaysSo) {
  EXPECT_EQ(richardson({}).verdict, GridVerdict::too_few);
  const Richardson one = richardson({{0.1, 3}});
  EXPECT_EQ(one.verdict, GridVerdict::too_few);
  EXPECT_TRUE(std::isnan(one.extrapolate));
  EXPECT_FALSE(one.words.empty());
}

TEST(Richardson, ScalesWithTheUnit) {
  for (const double unit : {1e-12, 1.0, 1e12}) {
    const Richardson found = richardson(power_law(2 * unit, unit, 1.5, {0.3, 0.2, 0.1, 0.07}));
    EXPECT_NEAR(found.order, 1.5, 1e-9) << unit;
    EXPECT_NEAR(found.extrapolate / unit, 2, 1e-9);
  }
}

/// Second order with a term of fourth: the order comes to 2 from above as the cells become small.
TEST(Richardson, SeesOrdersSettle) {
  std::vector<GridValue> grids;
  for (const double cell : {0.8, 0.4, 0.2, 0.1, 0.05, 0.025})
    grids.push_back({cell, 1 + cell * cell + 2 * std::pow(cell, 4)});
  const Richardson found = richardson(grids);
  EXPECT_GT(found.orders[0], found.orders[1]);
  EXPECT_GT(found.orders[1], found.orders[2]);
  EXPECT_TRUE(found.is_asymptotic);
  EXPECT_NEAR(found.order, 2, 0.05);
  EXPECT_LT(std::abs(found.extrapolate - 1), found.band);
  grids.resize(4);
  EXPECT_FALSE(richardson(grids).is_asymptotic);
}

}  // namespace
}  // namespace cloth::test::richardson_test
