#include "fit/identifiability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/dense_decompositions.h"

namespace cloth {
namespace {

double range_of(const FitParameter& parameter) {
  return parameter.scale == FitScale::logarithmic ? std::log(parameter.high / parameter.low) : 1;
}

/// Moved by `step` in the coordinate.
double moved(const FitParameter& parameter, double value, double step) {
  return parameter.scale == FitScale::logarithmic ? value * std::exp(step)
                                                  : value + step * (parameter.high - parameter.low);
}

bool has_part(const FitDirection& direction, std::size_t j) {
  return std::abs(direction.direction[j]) >= smallest_part;
}

const FitDirection* unseen_direction(const FitResult& result, std::size_t j) {
  for (const FitDirection& direction : result.directions)
    if (!direction.seen && has_part(direction, j)) return &direction;
  return nullptr;
}

/// Where another descent ended that fits as well; null if there is none far from parameter j's value.
const FitDescent* other_end(const FitProblem& problem, const FitResult& result, std::size_t j) {
  const FitParameter& parameter = problem.parameters[j];
  const FittedParameter& best = result.parameters[j];
  for (std::size_t d = 1; d < result.descents.size(); ++d) {
    const FitDescent& descent = result.descents[d];
    const double distance = parameter.scale == FitScale::logarithmic
                                ? std::abs(std::log(descent.end[j] / best.value))
                                : std::abs(descent.end[j] - best.value) / (parameter.high - parameter.low);
    if (descent.status == FitStatus::converged && descent.chi_squared < result.chi_squared + 4 &&
        distance > std::max(4 * best.relative_error, 1e-3))
      return &descent;
  }
  return nullptr;
}

void judge_parameter(const FitProblem& problem, FitResult& result, std::size_t j) {
  const FitParameter& parameter = problem.parameters[j];
  FittedParameter& found = result.parameters[j];
  const auto is = [&](FitVerdict verdict, const std::string& why) {
    found.verdict = verdict, found.why = why;
  };
  const double limit = std::min(largest_relative_error, largest_part_of_range * range_of(parameter));
  const double reach = 1e-6 * range_of(parameter);
  if (result.status != FitStatus::converged)
    is(FitVerdict::not_fitted, "The fit has not converged.");
  else if (const FitDirection* direction = unseen_direction(result, j))
    is(FitVerdict::unseen, "The data do not see " + direction->words + ".");
  else if (found.value <= moved(parameter, parameter.low, reach))
    is(FitVerdict::at_bound, fmt::format("The best value is the lower bound, {:.4g}.", parameter.low));
  else if (found.value >= moved(parameter, parameter.high, -reach))
    is(FitVerdict::at_bound, fmt::format("The best value is the upper bound, {:.4g}.", parameter.high));
  else if (!(found.relative_error <= limit))
    is(FitVerdict::uncertain,
       fmt::format("Its standard error is {:.2g} % of {}; more than {:.2g} % is too much.",
                   100 * found.relative_error,
                   parameter.scale == FitScale::logarithmic ? "its value" : "its range", 100 * limit));
  else if (const FitDescent* other = other_end(problem, result, j))
    is(FitVerdict::ambiguous, fmt::format("{:.4g} fits as well: chi squared is {:.4g} there and {:.4g} here.",
                                          other->end[j], other->chi_squared, result.chi_squared));
  else
    is(FitVerdict::identified, "");
}

}  // namespace

std::string words_of_direction(const std::vector<double>& direction,
                               const std::vector<FitParameter>& parameters) {
  std::size_t largest = 0;
  for (std::size_t j = 1; j < direction.size(); ++j)
    if (std::abs(direction[j]) > std::abs(direction[largest])) largest = j;
  std::string words;
  for (std::size_t j = 0; j < direction.size(); ++j) {
    if (std::abs(direction[j]) < smallest_part) continue;
    const double part = direction[j] / direction[largest];
    words += words.empty() ? "" : " with ";
    words += parameters[j].scale == FitScale::logarithmic
                 ? fmt::format("{} x {:.3g}", parameters[j].name, std::pow(1.1, part))
                 : fmt::format("{} {} {:.3g} % of its range", parameters[j].name, part < 0 ? "-" : "+",
                               10 * std::abs(part));
  }
  return words;
}

Information information_of(const Eigen::MatrixXd& jacobian, double error_scale,
                           const std::vector<FitParameter>& parameters) {
  const Eigen::Index count = jacobian.cols();
  const SingularParts parts = singular_parts(jacobian);
  Information information{Eigen::MatrixXd::Zero(count, count), {}};
  const double largest = parts.values.size() > 0 ? parts.values[0] : 0;
  const double least = std::max(smallest_seen_ratio * largest, 1e-150);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double value = k < parts.values.size() ? parts.values[k] : 0;
    const Eigen::VectorXd v = parts.right.col(k);
    const double deviation = error_scale / std::max(value, least);
    information.covariance += v * v.transpose() * deviation * deviation;
    FitDirection direction{.singular_value = value, .direction = {v.begin(), v.end()}};
    direction.seen = value > least && deviation < largest_seen_deviation;
    direction.words = words_of_direction(direction.direction, parameters);
    information.directions.push_back(std::move(direction));
  }
  return information;
}

void judge(const FitProblem& problem, const Information& information, FitResult& result) {
  const std::size_t count = problem.parameters.size();
  result.directions = information.directions;
  const Eigen::VectorXd deviation = information.covariance.diagonal().cwiseSqrt();
  result.correlation.assign(count, std::vector<double>(count, 1));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) {
      const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
      if (i != j) result.correlation[i][j] = information.covariance(a, b) / (deviation[a] * deviation[b]);
    }
  for (std::size_t j = 0; j < count; ++j) {
    const FitParameter& parameter = problem.parameters[j];
    FittedParameter& found = result.parameters[j];
    const bool unseen = unseen_direction(result, j) != nullptr;
    found.relative_error = unseen ? INFINITY : deviation[static_cast<Eigen::Index>(j)];
    found.standard_error =
        found.relative_error *
        (parameter.scale == FitScale::logarithmic ? found.value : parameter.high - parameter.low);
    found.low = unseen ? parameter.low : moved(parameter, found.value, -2 * found.relative_error);
    found.high = unseen ? parameter.high : moved(parameter, found.value, 2 * found.relative_error);
  }
  for (std::size_t j = 0; j < count; ++j) judge_parameter(problem, result, j);
}

double improbable_chi_squared(int degrees) {
  constexpr double z = 3.0902323;  // of the normal distribution
  const double n = degrees, part = 2 / (9 * n);
  return n * std::pow(1 - part + z * std::sqrt(part), 3);
}

}  // namespace cloth
