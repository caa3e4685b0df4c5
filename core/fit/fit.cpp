#include "fit/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "design/design.h"
#include "fit/fit_space.h"
#include "fit/identifiability.h"

namespace cloth {
namespace {

struct Start {
  Eigen::VectorXd u, residuals;
  double chi_squared = 0;
};

/// The start that was asked for, then the points of a Latin hypercube from the best on; those with a value.
std::vector<Start> starts_of(FitSpace& space, const FitOptions& options) {
  std::vector<Eigen::VectorXd> points;
  points.push_back(options.start.empty() ? space.between(std::vector<double>(space.dimensions(), 0.5))
                                         : space.clamped(space.coordinates(options.start)));
  if (options.starts > 0)
    for (const UnitPoint& unit :
         unit_design(Design::latin_hypercube, options.starts, space.dimensions(), options.seed))
      points.push_back(space.between(unit));
  const auto residuals = space.residuals(points);
  std::vector<Start> starts;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (residuals[i]) starts.push_back({points[i], *residuals[i], space.chi_squared(*residuals[i])});
  const auto by_chi = [](const Start& a, const Start& b) { return a.chi_squared < b.chi_squared; };
  const bool has_given = residuals[0].has_value();
  std::stable_sort(starts.begin() + (has_given ? 1 : 0), starts.end(), by_chi);
  starts.resize(std::min(starts.size(), std::max<std::size_t>(options.descents, 1)));
  return starts;
}

DescentEnd descend(FitSpace& space, const FitOptions& options, const Start& start) {
  if (options.method == FitMethod::derivative_free)
    return derivative_free(space, start.u, start.residuals, 20 * options.max_iterations);
  return levenberg_marquardt(space, start.u, start.residuals, options.max_iterations);
}

/// The best end of all descents, which are noted from the best on.
DescentEnd best_end(FitSpace& space, const FitOptions& options, const std::vector<Start>& starts,
                    FitResult& result) {
  std::vector<DescentEnd> ends;
  for (const Start& start : starts) {
    const std::size_t before = space.evaluations();
    ends.push_back(descend(space, options, start));
    const DescentEnd& end = ends.back();
    result.descents.push_back({end.status, space.values(start.u), space.values(end.u), end.chi_squared,
                               space.evaluations() - before});
  }
  const auto by_chi = [](const auto& a, const auto& b) { return a.chi_squared < b.chi_squared; };
  std::stable_sort(result.descents.begin(), result.descents.end(), by_chi);
  return *std::min_element(ends.begin(), ends.end(), by_chi);
}

/// What standard errors are multiplied by, and what is to be said of it.
double error_scale(const FitProblem& problem, FitResult& result) {
  const double reduced = result.degrees > 0 ? result.chi_squared / result.degrees : 1;
  if (result.degrees < 1 && result.chi_squared > improbable_chi_squared(1))
    result.cautions.emplace_back(
        "The model does not reach the measured values within the ranges of the parameters.");
  if (!problem.sigmas_known) {
    result.cautions.emplace_back(
        result.degrees > 0 ? "The measured values came without standard deviations: the residuals say how "
                             "large they are, which takes for granted that the model can fit them."
                           : "The measured values came without standard deviations, and there are no more of "
                             "them than parameters: the standard errors are those for the ones assumed.");
    return result.degrees > 0 ? std::sqrt(reduced) : 1;
  }
  if (result.degrees < 1 || result.chi_squared <= improbable_chi_squared(result.degrees)) return 1;
  result.cautions.push_back(fmt::format(
      "The model does not fit the data: chi squared is {:.4g} with {} degrees of freedom, which less than "
      "one "
      "measurement in a thousand would give. The standard errors are multiplied by {:.3g} (Birge 1932).",
      result.chi_squared, result.degrees, std::sqrt(reduced)));
  return std::sqrt(reduced);
}

/// Everything that is known at the end of the best descent.
void conclude(FitSpace& space, const FitProblem& problem, const DescentEnd& end, FitResult& result) {
  result.status = end.status;
  result.chi_squared = end.chi_squared;
  const std::vector<double> values = space.values(end.u);
  result.parameters.resize(values.size());
  for (std::size_t j = 0; j < values.size(); ++j) result.parameters[j].value = values[j];
  const Eigen::MatrixXd jacobian = space.jacobian(end.u, end.residuals);
  const Eigen::MatrixXd fitted = space.fitted_rows(jacobian);
  result.degrees = static_cast<int>(fitted.rows()) - static_cast<int>(fitted.cols());
  result.error_scale = error_scale(problem, result);
  const Information information = information_of(fitted, result.error_scale, problem.parameters);
  judge(problem, information, result);
  for (std::size_t t = 0; t < problem.targets.size(); ++t) {
    const FitTarget& target = problem.targets[t];
    const auto row = static_cast<Eigen::Index>(t);
    const Eigen::RowVectorXd slope = jacobian.row(row);
    result.simulated.push_back(target.measured + target.sigma * end.residuals[row]);
    result.simulated_error.push_back(target.sigma *
                                     std::sqrt((slope * information.covariance * slope.transpose()).value()));
  }
  if (result.status == FitStatus::stalled)
    result.cautions.emplace_back(
        "The descent ended where no step lowers chi squared though the slopes say that one should: the "
        "outputs jump or are rough. The derivative-free method, or a larger difference step, may help.");
  if (result.status == FitStatus::max_iterations)
    result.cautions.emplace_back("The descent was ended after the number of iterations that it may take.");
}

}  // namespace

bool FitResult::all_identified() const {
  return !parameters.empty() && std::all_of(parameters.begin(), parameters.end(), [](const auto& parameter) {
    return parameter.verdict == FitVerdict::identified;
  });
}

std::vector<std::string> broken_fit_rules(const FitProblem& problem, const FitOptions& options) {
  std::vector<std::string> rules;
  if (problem.parameters.empty()) rules.emplace_back("There is no parameter to vary.");
  for (const FitParameter& parameter : problem.parameters)
    if (!(parameter.low < parameter.high) || !std::isfinite(parameter.high - parameter.low) ||
        (parameter.scale == FitScale::logarithmic && !(parameter.low > 0)))
      rules.push_back(fmt::format("{}: its range must go up{}.", parameter.name,
                                  parameter.scale == FitScale::logarithmic ? " from above 0" : ""));
  if (std::none_of(problem.targets.begin(), problem.targets.end(),
                   [](const FitTarget& target) { return !target.held_out; }))
    rules.emplace_back("There is no target to fit.");
  for (const FitTarget& target : problem.targets) {
    if (!std::isfinite(target.measured)) rules.push_back(target.name + ": must be a number.");
    if (!(target.sigma > 0) || !std::isfinite(target.sigma))
      rules.push_back(target.name + ": its standard deviation must be above 0.");
  }
  if (!options.start.empty() && options.start.size() != problem.parameters.size())
    rules.emplace_back("The start must have a value for every parameter.");
  return rules;
}

FitResult fit(const FitProblem& problem, const FitOptions& options) {
  assert(broken_fit_rules(problem, options).empty());
  FitSpace space(problem, options);
  FitResult result;
  result.parameters.assign(problem.parameters.size(), {.value = NAN});
  result.chi_squared = std::numeric_limits<double>::infinity();
  try {
    const std::vector<Start> starts = starts_of(space, options);
    if (!starts.empty()) conclude(space, problem, best_end(space, options, starts, result), result);
  } catch (const FitStopped&) {
    result.status = FitStatus::stopped;
    result.chi_squared = space.best().chi_squared;
    for (std::size_t j = 0; j < space.best().values.size(); ++j)
      result.parameters[j].value = space.best().values[j];
  }
  result.evaluations = space.evaluations();
  result.failed = space.failed();
  return result;
}

}  // namespace cloth
