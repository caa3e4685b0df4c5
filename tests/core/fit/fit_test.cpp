// Fits of models in closed form: the textbook's answers, parameters that come back from noisy data as often
// as their standard errors say, and data that cannot tell.
#include "fit/fit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/heavy_strip.h"
#include "fit/identifiability.h"
#include "support/random.h"

namespace cloth::test::fit_test {
namespace {

using Values = std::vector<double>;
using Outputs = std::function<Values(const Values&)>;

FitModel model_of(Outputs outputs) {
  return [outputs](const std::vector<Values>& points) {
    std::vector<Values> all;
    for (const Values& point : points) all.push_back(outputs(point));
    return all;
  };
}

std::vector<FitTarget> targets_of(const Values& measured, double sigma) {
  std::vector<FitTarget> targets;
  for (const double value : measured)
    targets.push_back({.name = "y" + std::to_string(targets.size()), .measured = value, .sigma = sigma});
  return targets;
}

/// A straight line through points at t = 0, 1, ..., n - 1.
Outputs line(int count) {
  return [count](const Values& p) {
    Values outputs;
    for (int t = 0; t < count; ++t) outputs.push_back(p[0] + p[1] * t);
    return outputs;
  };
}

const std::vector<FitParameter> line_parameters{{"intercept", "m", -10, 10, FitScale::linear},
                                                {"slope", "m/s", -10, 10, FitScale::linear}};

TEST(Fit, OfAStraightLineIsTheTextbooks) {
  // Least squares through (0, 1.1), (1, 2.9), (2, 5.2), (3, 6.8): normal equations by hand.
  const Values measured{1.1, 2.9, 5.2, 6.8};
  const double sigma = 0.2;
  const FitResult found = fit({line_parameters, targets_of(measured, sigma), model_of(line(4))}, {});
  Eigen::MatrixXd a(4, 2);
  a << 1, 0, 1, 1, 1, 2, 1, 3;
  const Eigen::Vector4d y(1.1, 2.9, 5.2, 6.8);
  const Eigen::Matrix2d covariance = (a.transpose() * a).inverse() * sigma * sigma;
  const Eigen::Vector2d best = (a.transpose() * a).inverse() * (a.transpose() * y);
  ASSERT_EQ(found.status, FitStatus::converged);
  for (int j = 0; j < 2; ++j) {
    const FittedParameter& parameter = found.parameters[static_cast<std::size_t>(j)];
    EXPECT_NEAR(parameter.value, best[j], 1e-5);
    EXPECT_NEAR(parameter.standard_error, std::sqrt(covariance(j, j)), 1e-6);
    EXPECT_NEAR(parameter.low, best[j] - 2 * std::sqrt(covariance(j, j)), 2e-5);
    EXPECT_EQ(parameter.verdict, FitVerdict::identified) << parameter.why;
  }
  EXPECT_NEAR(found.correlation[0][1], covariance(0, 1) / std::sqrt(covariance(0, 0) * covariance(1, 1)),
              1e-6);
  EXPECT_NEAR(found.chi_squared, (a * best - y).squaredNorm() / (sigma * sigma), 1e-6);
  EXPECT_EQ(found.degrees, 2);
}

TEST(Fit, WithoutKnownSigmasHasThoseOfTheResiduals) {
  FitProblem problem{line_parameters, targets_of({1.1, 2.9, 5.2, 6.8}, 1), model_of(line(4))};
  const FitResult known = fit(problem, {});
  problem.sigmas_known = false;
  const FitResult unknown = fit(problem, {});
  const double scale = std::sqrt(known.chi_squared / 2);
  for (std::size_t j = 0; j < 2; ++j)
    EXPECT_NEAR(unknown.parameters[j].standard_error, scale * known.parameters[j].standard_error, 1e-6);
  EXPECT_EQ(unknown.cautions.size(), 1u);
  EXPECT_TRUE(known.cautions.empty());
}

TEST(Fit, OfAModelThatDoesNotFitSaysSoAndWidensTheErrors) {
  const FitResult found =
      fit({line_parameters, targets_of({0, 1, 4, 9, 16, 25}, 0.1), model_of(line(6))}, {});
  ASSERT_EQ(found.cautions.size(), 1u);
  EXPECT_NE(found.cautions[0].find("does not fit the data"), std::string::npos);
  EXPECT_NEAR(found.error_scale, std::sqrt(found.chi_squared / 4), 1e-9);
}

TEST(Fit, PredictsWhatIsHeldOutAndDoesNotUseIt) {
  std::vector<FitTarget> targets = targets_of({1.1, 2.9, 5.2, 6.8, 1000}, 0.2);
  targets[4].held_out = true;
  const FitResult all = fit({line_parameters, targets, model_of(line(5))}, {});
  targets.pop_back();
  const FitResult without = fit({line_parameters, targets, model_of(line(4))}, {});
  EXPECT_NEAR(all.parameters[1].value, without.parameters[1].value, 1e-6);
  EXPECT_NEAR(all.parameters[1].standard_error, without.parameters[1].standard_error, 1e-9);
  EXPECT_EQ(all.degrees, 2);
  const double predicted = all.parameters[0].value + 4 * all.parameters[1].value;
  EXPECT_NEAR(all.simulated[4], predicted, 1e-9);
  // Of a line through n points the prediction at t has sigma^2 (1/n + (t - mean)^2/S).
  EXPECT_NEAR(all.simulated_error[4], 0.2 * std::sqrt(0.25 + 2.5 * 2.5 / 5), 1e-6);
}

/// Droop over length of a strip under its own weight against ln Gamma: smooth through exact values, because
/// shooting for each of the thousands of strips below would take minutes.
double droop_over_length(double gamma) {
  constexpr double first = -2, step = 0.25;
  constexpr int count = 43;  // to Gamma of 4900
  static const Values table = [] {
    Values exact;
    for (int k = 0; k < count; ++k)
      exact.push_back(exact::heavy_cantilever(std::exp(first + step * k)).droop);
    return exact;
  }();
  const double place = (std::log(gamma) - first) / step;
  const auto k = static_cast<std::size_t>(std::clamp(place, 1.0, count - 3.0));
  const double t = place - static_cast<double>(k), p0 = table[k - 1], p1 = table[k], p2 = table[k + 1],
               p3 = table[k + 2];
  return p1 + t / 2 * (p2 - p0 + t * (2 * p0 - 5 * p1 + 4 * p2 - p3 + t * (3 * (p1 - p2) + p3 - p0)));
}

/// The droops (m) of strips of several lengths, of bending stiffness p[0].
constexpr double areal_density = 0.15, gravity = 9.81, bending = 2e-5;
Values droops(const Values& p) {
  Values droop;
  for (const double length : {0.06, 0.09, 0.12})
    droop.push_back(length * droop_over_length(exact::load_number(areal_density, gravity, length, p[0])));
  return droop;
}

TEST(Fit, GivesTheBendingOfACantileverBackWithinTwoStandardErrors) {
  // 200 times with other noise: 95 % of them, within four deviations of the binomial distribution, and the
  // errors are no larger than they need be: the sum of z^2 is that of 200 normal numbers.
  Random random;
  constexpr int times = 200;
  const double sigma = 0.001;
  int held = 0;
  double squares = 0;
  for (int t = 0; t < times; ++t) {
    Values measured = droops({bending});
    for (double& value : measured) value += random.normal(sigma);
    const FitResult found =
        fit({{{"bending", "N m", 1e-6, 1e-3}}, targets_of(measured, sigma), model_of(droops)},
            {.starts = 3, .descents = 1, .seed = static_cast<std::uint64_t>(t)});
    ASSERT_EQ(found.status, FitStatus::converged) << t;
    EXPECT_EQ(found.parameters[0].verdict, FitVerdict::identified) << found.parameters[0].why;
    const double z = std::log(found.parameters[0].value / bending) / found.parameters[0].relative_error;
    held += std::abs(z) <= 2 ? 1 : 0;
    squares += z * z;
  }
  RecordProperty("held", held);
  RecordProperty("squares", std::to_string(squares));
  EXPECT_GE(held, times * 0.95 - 4 * std::sqrt(times * 0.95 * 0.05));
  EXPECT_NEAR(squares, times, 4 * std::sqrt(2.0 * times));
}

TEST(Fit, RefusesAPairOfWhichOnlyTheProductMatters) {
  const auto product = [](const Values& p) { return Values{p[0] * p[1], std::sqrt(p[0] * p[1]), 3 * p[2]}; };
  const FitResult found = fit({{{"a", "", 0.1, 100}, {"b", "", 0.1, 100}, {"c", "", 0.1, 100}},
                               targets_of({12, std::sqrt(12), 6}, 0.01),
                               model_of(product)},
                              {});
  ASSERT_EQ(found.status, FitStatus::converged);
  EXPECT_EQ(found.parameters[0].verdict, FitVerdict::unseen);
  EXPECT_EQ(found.parameters[1].verdict, FitVerdict::unseen);
  EXPECT_EQ(found.parameters[2].verdict, FitVerdict::identified) << found.parameters[2].why;
  EXPECT_EQ(found.parameters[0].why, "The data do not see a x 1.1 with b x 0.909.");
  EXPECT_TRUE(std::isinf(found.parameters[0].standard_error));
  EXPECT_NEAR(found.parameters[0].value * found.parameters[1].value, 12, 0.01);
  EXPECT_NEAR(found.parameters[2].value, 2, 1e-4);
  EXPECT_NEAR(found.correlation[0][1], -1, 1e-6);
  EXPECT_FALSE(found.directions.back().seen);
  EXPECT_FALSE(found.all_identified());
}

TEST(Fit, RefusesWhatNoOutputDependsOnAndMoreParametersThanTargets) {
  const auto one = [](const Values& p) { return Values{p[0] * p[0]}; };
  const FitResult blind =
      fit({{{"a", "", 0.1, 100}, {"b", "", 0.1, 100}}, targets_of({9}, 0.1), model_of(one)}, {});
  EXPECT_EQ(blind.parameters[0].verdict, FitVerdict::identified) << blind.parameters[0].why;
  EXPECT_NEAR(blind.parameters[0].value, 3, 1e-3);
  EXPECT_EQ(blind.parameters[1].verdict, FitVerdict::unseen);
  EXPECT_EQ(blind.parameters[1].why, "The data do not see b x 1.1.");
  const auto sum = [](const Values& p) { return Values{p[0] + p[1]}; };
  const FitResult few =
      fit({{{"a", "", 0.1, 100}, {"b", "", 0.1, 100}}, targets_of({9}, 0.1), model_of(sum)}, {});
  for (const FittedParameter& parameter : few.parameters) EXPECT_EQ(parameter.verdict, FitVerdict::unseen);
}

TEST(Fit, CallsAParameterUncertainThatTheDataSeeTooWeakly) {
  const auto weak = [](const Values& p) { return Values{1 + 0.01 * std::log(p[0])}; };
  const auto verdict = [&](double sigma) {
    return fit({{{"a", "", 0.01, 100}}, targets_of({1}, sigma), model_of(weak)}, {}).parameters[0].verdict;
  };
  EXPECT_EQ(verdict(0.001), FitVerdict::identified);  // 10 %
  EXPECT_EQ(verdict(0.005), FitVerdict::uncertain);   // 50 %
  EXPECT_EQ(verdict(0.02), FitVerdict::unseen);       // a factor of e^2
}

TEST(Fit, EndsAtABoundAndSaysSo) {
  const auto itself = [](const Values& p) { return Values{p[0], 2 * p[1]}; };
  const FitResult found =
      fit({{{"a", "", 1, 10}, {"b", "", 1, 10}}, targets_of({30, 8}, 0.1), model_of(itself)}, {});
  EXPECT_EQ(found.status, FitStatus::converged);
  EXPECT_EQ(found.parameters[0].verdict, FitVerdict::at_bound);
  EXPECT_EQ(found.parameters[0].why, "The best value is the upper bound, 10.");
  ASSERT_EQ(found.cautions.size(), 1u);
  EXPECT_NE(found.cautions[0].find("does not reach the measured values"), std::string::npos);
  EXPECT_NEAR(found.parameters[1].value, 4, 1e-3);
}

TEST(Fit, FindsTheLowestOfSeveralValleysAndNamesOneThatIsAsLow) {
  const auto wave = [](const Values& p) { return Values{std::cos(6 * p[0]), 0.1 * p[0]}; };
  const std::vector<FitParameter> parameters{{"angle", "rad", 0, 3, FitScale::linear}};
  const FitResult one = fit({parameters, targets_of({std::cos(6 * 2.3), 0.23}, 0.01), model_of(wave)}, {});
  EXPECT_NEAR(one.parameters[0].value, 2.3, 1e-3);
  EXPECT_EQ(one.parameters[0].verdict, FitVerdict::identified) << one.parameters[0].why;
  const auto periodic = [](const Values& p) { return Values{std::cos(6 * p[0])}; };
  const FitResult many = fit({parameters, targets_of({0.5}, 0.01), model_of(periodic)}, {.descents = 6});
  EXPECT_EQ(many.parameters[0].verdict, FitVerdict::ambiguous);
}

TEST(Fit, WithoutDerivativesFindsAMinimumOfAnOutputThatJumps) {
  // Steps of 1 % hide the slope from differences of 0.1 %.
  const auto jumping = [](const Values& p) {
    const auto jump = [](double x) { return std::floor(100 * std::log(x)) / 100; };
    return Values{jump(p[0]) + jump(p[1]), jump(p[0]) - 2 * jump(p[1])};
  };
  const FitProblem problem{{{"a", "", 0.1, 10}, {"b", "", 0.1, 10}},
                           targets_of({std::log(2) + std::log(0.5), std::log(2) - 2 * std::log(0.5)}, 0.01),
                           model_of(jumping)};
  FitOptions options{.method = FitMethod::derivative_free};
  const FitResult found = fit(problem, options);
  EXPECT_EQ(found.status, FitStatus::converged);
  EXPECT_NEAR(found.parameters[0].value, 2, 0.05);
  EXPECT_NEAR(found.parameters[1].value, 0.5, 0.01);
  EXPECT_LT(found.chi_squared, 4);
  options.method = FitMethod::levenberg_marquardt;
  EXPECT_GT(fit(problem, options).chi_squared, 100);
}

TEST(Fit, WithoutDerivativesFindsOneParameterToo) {
  const auto jumping = [](const Values& p) { return Values{std::round(20 * p[0]) / 20}; };
  const FitResult found = fit({{{"a", "", 0.1, 10}}, targets_of({3.3}, 0.05), model_of(jumping)},
                              {.method = FitMethod::derivative_free});
  EXPECT_NEAR(found.parameters[0].value, 3.3, 0.03);
}

TEST(Fit, AsksForTheRunsOfAGradientInOneBatch) {
  std::vector<std::size_t> batches;
  const Outputs sum = [](const Values& p) { return Values{p[0] + p[1] + p[2], p[0] * p[1], p[2]}; };
  const FitModel model = [&](const std::vector<Values>& points) {
    batches.push_back(points.size());
    return model_of(sum)(points);
  };
  const FitResult found = fit(
      {{{"a", "", 0.1, 100}, {"b", "", 0.1, 100}, {"c", "", 0.1, 100}}, targets_of({9, 8, 3}, 0.1), model},
      {.starts = 10});
  EXPECT_EQ(batches.front(), 11u);
  EXPECT_EQ(batches[1], 6u);
  std::size_t all = 0;
  for (const std::size_t batch : batches) all += batch;
  EXPECT_EQ(found.evaluations, all);
}

TEST(Fit, GoesRoundRunsThatFail) {
  const auto partial = [](const Values& p) {
    return Values{p[0] > 5 ? std::numeric_limits<double>::quiet_NaN() : p[0] * p[0]};
  };
  const FitResult found =
      fit({{{"a", "", 0.1, 100}}, targets_of({16}, 0.1), model_of(partial)}, {.start = {4.9}});
  EXPECT_EQ(found.status, FitStatus::converged);
  EXPECT_NEAR(found.parameters[0].value, 4, 1e-3);
  EXPECT_GT(found.failed, 0u);
  const auto never = [](const Values&) { return Values{}; };
  const FitResult none = fit({{{"a", "", 0.1, 100}}, targets_of({16}, 0.1), model_of(never)}, {});
  EXPECT_EQ(none.status, FitStatus::no_start);
  EXPECT_EQ(none.parameters[0].verdict, FitVerdict::not_fitted);
}

TEST(Fit, StopsWhereItIsAskedToWithTheBestSoFar) {
  for (const FitMethod method : {FitMethod::levenberg_marquardt, FitMethod::derivative_free}) {
    int batches = 0;
    FitOptions options{.method = method};
    options.progress = [&](const FitProgress&) { return ++batches < 3; };
    const FitResult found =
        fit({line_parameters, targets_of({1.1, 2.9, 5.2, 6.8}, 0.2), model_of(line(4))}, options);
    EXPECT_EQ(found.status, FitStatus::stopped);
    EXPECT_EQ(batches, 3);
    EXPECT_TRUE(std::isfinite(found.chi_squared));
    EXPECT_TRUE(std::isfinite(found.parameters[1].value));
  }
}

TEST(Fit, ImprobableChiSquaredIsThatOfTables) {
  EXPECT_NEAR(improbable_chi_squared(1), 10.828, 0.35);
  EXPECT_NEAR(improbable_chi_squared(10), 29.588, 0.2);
  EXPECT_NEAR(improbable_chi_squared(100), 149.449, 0.1);
}

TEST(Fit, RefusesProblemsThatAreNone) {
  const FitProblem empty;
  EXPECT_EQ(broken_fit_rules(empty, {}).size(), 2u);
  FitProblem bad{{{"a", "", 0, 1}, {"b", "", 2, 1, FitScale::linear}}, targets_of({1}, 0), model_of(line(1))};
  EXPECT_EQ(broken_fit_rules(bad, {.start = {1}}).size(), 4u);
}

}  // namespace
}  // namespace cloth::test::fit_test
