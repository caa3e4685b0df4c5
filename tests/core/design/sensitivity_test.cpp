// Sobol' indices and Morris' effects of functions whose own are known.
#include "design/sensitivity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "support/random.h"

namespace cloth::test::sensitivity_test {
namespace {

using Function = std::function<double(const UnitPoint&)>;
constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::vector<double> outputs_of(const UnitPoints& rows, const Function& function) {
  std::vector<double> outputs;
  for (const UnitPoint& row : rows) outputs.push_back(function(row));
  return outputs;
}

/// Ishigami and Homma (1990): sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1 over [-pi, pi]^3.
double ishigami(const UnitPoint& point) {
  const auto x = [&](std::size_t j) { return std::numbers::pi * (2 * point[j] - 1); };
  const double s = std::sin(x(1)), x3 = x(2);
  return std::sin(x(0)) + 7 * s * s + 0.1 * x3 * x3 * x3 * x3 * std::sin(x(0));
}
constexpr double ishigami_variance = 13.8445879;
constexpr std::array ishigami_first{0.3139052, 0.4424111, 0.0};
constexpr std::array ishigami_total{0.5575889, 0.4424111, 0.2436837};

SobolIndices ishigami_indices(std::size_t n, std::uint64_t seed) {
  return sobol_indices(outputs_of(unit_design(Design::saltelli, n, 3, seed), ishigami), 3, seed);
}

TEST(SobolIndices, OfIshigamiAreItsOwnWithinTheInterval) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const SobolIndices found = ishigami_indices(1024, seed);
    EXPECT_NEAR(found.variance, ishigami_variance, 0.02 * ishigami_variance);
    EXPECT_NEAR(found.mean, 3.5, 0.02);
    for (std::size_t j = 0; j < 3; ++j) {
      const auto& [first, total] = found.parameters[j];
      EXPECT_LE(first.low, ishigami_first[j]) << j;
      EXPECT_GE(first.high, ishigami_first[j]) << j;
      EXPECT_LE(total.low, ishigami_total[j]) << j;
      EXPECT_GE(total.high, ishigami_total[j]) << j;
      EXPECT_LT(first.high - first.low, 0.25) << j;
      EXPECT_LT(total.high - total.low, 0.2) << j;
    }
  }
}

/// Root of the mean square over seeds and indices.
double ishigami_error(std::size_t n) {
  double sum = 0;
  constexpr int seeds = 6;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const SobolIndices found = ishigami_indices(n, seed);
    for (std::size_t j = 0; j < 3; ++j)
      sum += std::pow(found.parameters[j].first.value - ishigami_first[j], 2) +
             std::pow(found.parameters[j].total.value - ishigami_total[j], 2);
  }
  return std::sqrt(sum / (6 * seeds));
}

TEST(SobolIndices, OfIshigamiComeCloserAtLeastLikeOneOverTheNumberOfRows) {
  const double few = ishigami_error(64), many = ishigami_error(4096);
  RecordProperty("error_64", std::to_string(few));
  RecordProperty("error_4096", std::to_string(many));
  EXPECT_LT(many, few / 64);
  EXPECT_LT(many, 1e-3);
}

TEST(SobolIndices, OfASumAreThePartsOfTheVarianceOfItsTerms) {
  // Var(c x) = c^2/12: 1 : 4 : 9 : 16.
  const auto sum = [](const UnitPoint& x) { return x[0] + 2 * x[1] + 3 * x[2] + 4 * x[3] + 100; };
  const SobolIndices found = sobol_indices(outputs_of(unit_design(Design::saltelli, 1024, 4, 1), sum), 4);
  double all = 0;
  for (std::size_t j = 0; j < 4; ++j) {
    const double part = static_cast<double>((j + 1) * (j + 1)) / 30;
    EXPECT_NEAR(found.parameters[j].first.value, part, 3e-3) << j;
    EXPECT_NEAR(found.parameters[j].total.value, part, 3e-3) << j;
    all += found.parameters[j].first.value;
  }
  EXPECT_NEAR(all, 1, 3e-3);
}

TEST(SobolIndices, OfAnInputWithoutInfluenceAreZero) {
  const auto function = [](const UnitPoint& x) { return std::exp(x[0]) * x[2]; };
  const SobolIndices found = sobol_indices(outputs_of(unit_design(Design::saltelli, 64, 3, 1), function), 3);
  for (const Estimate& index : {found.parameters[1].first, found.parameters[1].total}) {
    EXPECT_EQ(index.value, 0);
    EXPECT_EQ(index.low, 0);
    EXPECT_EQ(index.high, 0);
  }
}

TEST(SobolIndices, OfAProductSeeTheInteraction) {
  // (x1 - 1/2)(x2 - 1/2): all of the variance is the interaction's.
  const auto function = [](const UnitPoint& x) { return (x[0] - 0.5) * (x[1] - 0.5); };
  const SobolIndices found =
      sobol_indices(outputs_of(unit_design(Design::saltelli, 4096, 2, 1), function), 2);
  for (const SobolIndex& parameter : found.parameters) {
    EXPECT_NEAR(parameter.first.value, 0, 0.01);
    EXPECT_NEAR(parameter.total.value, 1, 0.01);
  }
}

TEST(SobolIndices, LeaveTheWholeRowOfAFailedRunOutAndCountIt) {
  const UnitPoints rows = unit_design(Design::saltelli, 128, 3, 4);
  std::vector<double> outputs = outputs_of(rows, ishigami);
  std::vector<double> without = outputs;
  without.erase(without.begin() + 10, without.begin() + 15);
  outputs[12] = none;
  outputs[14] = std::numeric_limits<double>::infinity();
  const SobolIndices found = sobol_indices(outputs, 3), same = sobol_indices(without, 3);
  EXPECT_EQ(found.failed, 2u);
  EXPECT_EQ(found.left_out, 1u);
  EXPECT_EQ(found.rows, 127u);
  EXPECT_EQ(found.parameters[0].first.value, same.parameters[0].first.value);
  EXPECT_EQ(found.parameters[2].total.high, same.parameters[2].total.high);
  // Half a row at the end is not there yet.
  EXPECT_EQ(sobol_indices(std::span(without).first(13), 3).rows, 2u);
}

TEST(SobolIndices, OfNothingToCompareAreNoNumbers) {
  const std::vector<double> all_failed(20, none), constant(20, 3.0), one_row{1, 2, 3, 4, 5};
  for (const auto& outputs : {all_failed, constant, one_row, std::vector<double>()}) {
    const SobolIndices found = sobol_indices(outputs, 3);
    ASSERT_EQ(found.parameters.size(), 3u);
    for (const SobolIndex& parameter : found.parameters) {
      EXPECT_TRUE(std::isnan(parameter.first.value));
      EXPECT_TRUE(std::isnan(parameter.total.high));
    }
  }
}

TEST(SobolIndices, HaveIntervalsThatHoldTheTruthNineteenTimesInTwenty) {
  // Of rows at random, which the bootstrap is for; 200 times, and 95 % of them within four deviations.
  Random random;
  int held = 0;
  constexpr int times = 200;
  for (int t = 0; t < times; ++t) {
    std::vector<double> outputs;
    for (int i = 0; i < 400; ++i) {
      const double a1 = random.uniform(0, 1), a2 = random.uniform(0, 1), b1 = random.uniform(0, 1),
                   b2 = random.uniform(0, 1);
      for (const auto& [x, y] : {std::pair{a1, a2}, {b1, b2}, {b1, a2}, {a1, b2}})
        outputs.push_back(x + 2 * y);
    }
    const Estimate total = sobol_indices(outputs, 2, static_cast<std::uint64_t>(t)).parameters[0].total;
    held += total.low <= 0.2 && 0.2 <= total.high ? 1 : 0;
  }
  RecordProperty("held", held);
  EXPECT_GE(held, times * 0.95 - 4 * std::sqrt(times * 0.95 * 0.05));
  EXPECT_LE(held, times - 1);
}

TEST(MorrisScreening, OfALinearFunctionHasItsSlopesWithoutSpread) {
  const auto linear = [](const UnitPoint& x) { return 3 * x[0] - 5 * x[1] + 7; };
  const UnitPoints rows = unit_design(Design::morris, 10, 3, 1);
  const MorrisScreening found = morris_screening(rows, outputs_of(rows, linear));
  EXPECT_EQ(found.trajectories, 10u);
  const std::array slopes{3.0, -5.0, 0.0};
  for (std::size_t j = 0; j < 3; ++j) {
    const MorrisEffect& effect = found.parameters[j];
    EXPECT_NEAR(effect.mu, slopes[j], 1e-12);
    EXPECT_NEAR(effect.mu_star.value, std::abs(slopes[j]), 1e-12);
    EXPECT_NEAR(effect.mu_star.low, std::abs(slopes[j]), 1e-12);
    EXPECT_NEAR(effect.sigma, 0, 1e-12);
    EXPECT_EQ(effect.effects, 10u);
  }
  EXPECT_EQ(found.parameters[2].mu_star.value, 0);
}

TEST(MorrisScreening, OfAHillHasMuStarWhereMuVanishes) {
  // (x - 1/2)^2 over the levels: steps 0 -> 2/3 and back give +-1/3 of the range: mu 0, mu* 1/3, sigma 1/3.
  const auto hill = [](const UnitPoint& x) { return (x[0] - 0.5) * (x[0] - 0.5); };
  const UnitPoints rows = unit_design(Design::morris, 2000, 1, 3);
  const MorrisEffect effect = morris_screening(rows, outputs_of(rows, hill)).parameters[0];
  EXPECT_NEAR(effect.mu, 0, 4 * (1.0 / 3) / std::sqrt(2000));
  EXPECT_NEAR(effect.mu_star.value, 1.0 / 3, 1e-12);
  EXPECT_NEAR(effect.sigma, 1.0 / 3, 1e-3);
}

TEST(MorrisScreening, OfAProductHasASpread) {
  const auto product = [](const UnitPoint& x) { return x[0] * x[1] + 0.2 * x[2]; };
  const UnitPoints rows = unit_design(Design::morris, 100, 3, 3);
  const MorrisScreening found = morris_screening(rows, outputs_of(rows, product));
  EXPECT_GT(found.parameters[0].sigma, 0.3);
  EXPECT_LT(found.parameters[2].sigma, 1e-12);
}

TEST(MorrisScreening, TakesTheEffectsBesideAFailedRunOut) {
  const UnitPoints rows = unit_design(Design::morris, 5, 3, 3);
  std::vector<double> outputs = outputs_of(rows, ishigami);
  outputs[5] = none;  // the second run of the second trajectory
  const MorrisScreening found = morris_screening(rows, outputs);
  std::size_t effects = 0;
  for (const MorrisEffect& effect : found.parameters) {
    effects += effect.effects;
    EXPECT_TRUE(std::isfinite(effect.mu));
  }
  EXPECT_EQ(effects, 13u);
  EXPECT_EQ(found.failed, 1u);
  outputs.resize(10);  // the third trajectory is half run
  EXPECT_EQ(morris_screening(rows, outputs).trajectories, 2u);
}

}  // namespace
}  // namespace cloth::test::sensitivity_test
