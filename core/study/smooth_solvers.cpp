#include "study/smooth_solvers.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cloth {
namespace {

constexpr int max_columns = 12;
constexpr int usual_columns = 8;
constexpr double eps = std::numeric_limits<double>::epsilon();

double scaled(const Eigen::VectorXd& change, const Eigen::VectorXd& scale) {
  return (change.array() / scale.array()).abs().maxCoeff();
}

/// Legendre's polynomial of degree n at x, and its derivative.
std::pair<double, double> legendre(int n, double x) {
  double before = 1, value = x;
  for (int k = 2; k <= n; ++k) {
    const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
    before = value;
    value = next;
  }
  return {value, n * (x * value - before) / (x * x - 1)};
}

/// Lagrange's polynomial of node j at x.
template <class Nodes>
double lagrange(const Nodes& nodes, int j, double x) {
  double value = 1;
  for (int k = 0; k < nodes.size(); ++k)
    if (k != j) value *= (x - nodes(k)) / (nodes(j) - nodes(k));
  return value;
}

}  // namespace

void Extrapolation::midpoint_rule(const Derivative& f, double begin, double step, int parts,
                                  const Eigen::VectorXd& y, Eigen::VectorXd& result) {
  const double h = step / parts;
  previous_ = y;
  middle_ = y + h * slope_;
  for (int m = 1; m < parts; ++m) {
    f(begin + m * h, middle_, derivative_);
    next_ = previous_ + 2 * h * derivative_;
    previous_.swap(middle_);
    middle_.swap(next_);
  }
  f(begin + step, middle_, derivative_);
  result = 0.5 * (middle_ + previous_ + h * derivative_);
}

/// The error of the best column, in tolerances; `columns` says how many were made. The result is
/// table_.front().
double Extrapolation::try_step(const Derivative& f, double begin, double step, const Eigen::VectorXd& y,
                               int& columns) {
  table_.resize(max_columns);  // table_[k] after row j: the entry of j - k extrapolations
  double error = std::numeric_limits<double>::infinity();
  for (int j = 0; j < max_columns; ++j) {
    const auto row = static_cast<std::size_t>(j);
    midpoint_rule(f, begin, step, 2 * (j + 1), y, table_[row]);
    Eigen::VectorXd change;
    for (int k = j - 1; k >= 0; --k) {
      const double ratio = static_cast<double>(j + 1) / (k + 1);
      const auto column = static_cast<std::size_t>(k);
      change = (table_[column + 1] - table_[column]) / (ratio * ratio - 1);
      table_[column] = table_[column + 1] + change;
    }
    columns = j + 1;
    if (!table_.front().allFinite()) return std::numeric_limits<double>::infinity();
    if (j < 2) continue;
    error = scaled(change, scale_) / tolerance_;
    if (error <= 1) return error;
  }
  return error;
}

std::optional<std::string> Extrapolation::advance(const Derivative& f, double begin, double end,
                                                  Eigen::VectorXd& y, const StopTest& stop) {
  slope_.resize(y.size());
  derivative_.resize(y.size());
  double time = begin;
  if (!(step_ > 0)) step_ = end - begin;
  while (time < end) {
    if (is_to_stop(stop)) return "stopped";
    const bool last = time + step_ * (1 + 1e-9) >= end;
    const double step = last ? end - time : step_;
    if (step <= 16 * eps * std::max(std::abs(end), end - begin))
      return "the extrapolation's step has vanished";
    f(time, y, slope_);
    int columns = 0;
    if (try_step(f, time, step, y, columns) > 1) {
      step_ = step / 2;
      continue;
    }
    y = table_.front();
    if (!y.allFinite()) return "the motion is not finite";
    time = last ? end : time + step;
    if (columns < usual_columns && (!last || step >= step_)) step_ = 1.4 * step;
    if (columns > usual_columns + 1) step_ = 0.8 * step;
  }
  return std::nullopt;
}

Collocation::Collocation(Eigen::VectorXd scale) : scale_(std::move(scale)) {
  for (int i = 0; i < stages; ++i) {
    double x = -std::cos(M_PI * (i + 0.75) / (stages + 0.5));
    for (int iteration = 0; iteration < 20; ++iteration) {
      const auto [value, slope] = legendre(stages, x);
      x -= value / slope;
    }
    const double slope = legendre(stages, x).second;
    nodes_(i) = 0.5 * (1 + x);
    weights_(i) = 1 / ((1 - x * x) * slope * slope);
  }
  for (int i = 0; i < stages; ++i)
    for (int j = 0; j < stages; ++j) {
      inner_(i, j) = 0;  // the integral of node j's polynomial from 0 to node i, exact by the rule itself
      for (int q = 0; q < stages; ++q)
        inner_(i, j) += nodes_(i) * weights_(q) * lagrange(nodes_, j, nodes_(i) * nodes_(q));
      forward_(i, j) = lagrange(nodes_, j, 1 + nodes_(i));
    }
}

bool Collocation::solve_stages(const Derivative& f, double begin, double step, const Eigen::VectorXd& y) {
  constexpr int max_iterations = 100;
  double before = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    double change = 0;
    for (int i = 0; i < stages; ++i) {
      stage_ = y;
      stage_.noalias() += step * (slopes_ * inner_.row(i).transpose());
      f(begin + nodes_(i) * step, stage_, derivative_);
      change = std::max(change, step * scaled(derivative_ - slopes_.col(i), scale_));
      slopes_.col(i) = derivative_;
    }
    if (!std::isfinite(change)) return false;
    if (change <= 4 * eps) return true;
    if (change <= 1e-13 && change >= 0.5 * before) return true;  // rounding goes round
    before = change;
  }
  return false;
}

std::optional<std::string> Collocation::advance(const Derivative& f, double begin, double end, int steps,
                                                Eigen::VectorXd& y, const StopTest& stop) {
  const double step = (end - begin) / steps;
  stage_.resize(y.size());
  derivative_.resize(y.size());
  if (last_step_ <= 0) {
    f(begin, y, derivative_);
    slopes_ = derivative_.replicate(1, stages);
  }
  for (int n = 0; n < steps; ++n) {
    if (is_to_stop(stop)) return "stopped";
    if (last_step_ > 0 && std::abs(step / last_step_ - 1) < 1e-6) {
      guess_.noalias() = slopes_ * forward_.transpose();
      slopes_.swap(guess_);
    }
    if (!solve_stages(f, begin + n * step, step, y)) return "the collocation's iteration does not converge";
    y.noalias() += step * (slopes_ * weights_);
    last_step_ = step;
  }
  if (!y.allFinite()) return "the motion is not finite";
  return std::nullopt;
}

}  // namespace cloth
