#include "fit/fit_space.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace cloth {
namespace {

double to_coordinate(const FitParameter& parameter, double value) {
  if (parameter.scale == FitScale::logarithmic) return std::log(value);
  return (value - parameter.low) / (parameter.high - parameter.low);
}

double to_value(const FitParameter& parameter, double u) {
  const double value = parameter.scale == FitScale::logarithmic
                           ? std::exp(u)
                           : parameter.low + u * (parameter.high - parameter.low);
  return std::clamp(value, parameter.low, parameter.high);  // exp(log(x)) may be beside x
}

}  // namespace

FitSpace::FitSpace(const FitProblem& problem, const FitOptions& options)
    : problem_(problem), options_(options) {
  for (const FitParameter& parameter : problem.parameters) {
    low_.push_back(to_coordinate(parameter, parameter.low));
    high_.push_back(to_coordinate(parameter, parameter.high));
  }
  const double usual = options.method == FitMethod::derivative_free ? 0.05 : 0.001;
  step_ = options.difference_step > 0 ? options.difference_step : usual;
  best_.chi_squared = std::numeric_limits<double>::infinity();
}

std::vector<double> FitSpace::values(const Eigen::VectorXd& u) const {
  std::vector<double> values;
  for (std::size_t j = 0; j < dimensions(); ++j)
    values.push_back(to_value(problem_.parameters[j], u[static_cast<Eigen::Index>(j)]));
  return values;
}

Eigen::VectorXd FitSpace::coordinates(const std::vector<double>& values) const {
  Eigen::VectorXd u(static_cast<Eigen::Index>(dimensions()));
  for (std::size_t j = 0; j < dimensions(); ++j)
    u[static_cast<Eigen::Index>(j)] = to_coordinate(problem_.parameters[j], values[j]);
  return u;
}

Eigen::VectorXd FitSpace::between(const std::vector<double>& unit) const {
  Eigen::VectorXd u(static_cast<Eigen::Index>(dimensions()));
  for (std::size_t j = 0; j < dimensions(); ++j)
    u[static_cast<Eigen::Index>(j)] = low_[j] + unit[j] * (high_[j] - low_[j]);
  return u;
}

Eigen::VectorXd FitSpace::clamped(const Eigen::VectorXd& u) const {
  Eigen::VectorXd inside = u;
  for (std::size_t j = 0; j < dimensions(); ++j) {
    double& place = inside[static_cast<Eigen::Index>(j)];
    place = std::clamp(place, low_[j], high_[j]);
  }
  return inside;
}

std::vector<FitSpace::Residuals> FitSpace::residuals(const std::vector<Eigen::VectorXd>& points) {
  std::vector<std::vector<double>> all;
  for (const Eigen::VectorXd& u : points) all.push_back(values(u));
  const auto outputs = problem_.evaluate(all);
  std::vector<Residuals> found(points.size());
  evaluations_ += points.size();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t count = problem_.targets.size();
    Eigen::VectorXd residual(static_cast<Eigen::Index>(count));
    for (std::size_t t = 0; t < count; ++t)
      residual[static_cast<Eigen::Index>(t)] =
          i < outputs.size() && t < outputs[i].size()
              ? (outputs[i][t] - problem_.targets[t].measured) / problem_.targets[t].sigma
              : std::numeric_limits<double>::quiet_NaN();
    if (!residual.allFinite()) {
      ++failed_;
      continue;
    }
    if (const double chi = chi_squared(residual); chi < best_.chi_squared)
      best_.chi_squared = chi, best_.values = all[i];
    found[i] = std::move(residual);
  }
  best_.evaluations = evaluations_;
  if (options_.progress && !options_.progress(best_)) throw FitStopped{};
  return found;
}

Eigen::MatrixXd FitSpace::jacobian(const Eigen::VectorXd& u, const Eigen::VectorXd& centre) {
  std::vector<Eigen::VectorXd> points;
  for (Eigen::Index j = 0; j < u.size(); ++j)
    for (const double step : {-step_, step_}) {
      Eigen::VectorXd point = u;
      point[j] += step;
      points.push_back(clamped(point));
    }
  const std::vector<Residuals> found = residuals(points);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(centre.size(), u.size());
  for (Eigen::Index j = 0; j < u.size(); ++j) {
    const auto below = static_cast<std::size_t>(2 * j), above = below + 1;
    const double from = found[below] ? points[below][j] : u[j], to = found[above] ? points[above][j] : u[j];
    if (to > from)
      jacobian.col(j) = (found[above].value_or(centre) - found[below].value_or(centre)) / (to - from);
  }
  return jacobian;
}

double FitSpace::chi_squared(const Eigen::VectorXd& residuals) const {
  double sum = 0;
  for (std::size_t t = 0; t < problem_.targets.size(); ++t)
    if (!problem_.targets[t].held_out) sum += std::pow(residuals[static_cast<Eigen::Index>(t)], 2);
  return sum;
}

Eigen::MatrixXd FitSpace::fitted_rows(const Eigen::MatrixXd& all) const {
  std::vector<Eigen::Index> rows;
  for (std::size_t t = 0; t < problem_.targets.size(); ++t)
    if (!problem_.targets[t].held_out) rows.push_back(static_cast<Eigen::Index>(t));
  return all(rows, Eigen::all);
}

}  // namespace cloth
