#include "exact/elastica.h"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace cloth::exact {
namespace {

/// x, y, angle, curvature.
using Values = Eigen::Vector4d;

Values slope_at(const Values& at, double horizontal, double vertical) {
  const double sine = std::sin(at[2]), cosine = std::cos(at[2]);
  return {sine, -cosine, at[3], -(horizontal * cosine + vertical * sine)};
}

template <typename Visit>
void integrate(const ElasticaPoint& start, const ElasticaLoad& load, double length, int steps, Visit visit) {
  const double h = length / steps;
  Values at(start.x, start.y, start.angle, start.curvature);
  for (int k = 0; k < steps; ++k) {
    const double before = load.vertical + load.weight * (k * h), middle = before + load.weight * h / 2;
    const Values a = slope_at(at, load.horizontal, before);
    const Values b = slope_at(at + h / 2 * a, load.horizontal, middle);
    const Values c = slope_at(at + h / 2 * b, load.horizontal, middle);
    const Values d = slope_at(at + h * c, load.horizontal, before + load.weight * h);
    at += h / 6 * (a + 2 * b + 2 * c + d);
    visit({start.arc + (k + 1) * h, at[0], at[1], at[2], at[3]});
  }
}

Eigen::MatrixXd derivatives(const Conditions& conditions, const Eigen::VectorXd& at) {
  Eigen::MatrixXd matrix(at.size(), at.size());
  for (Eigen::Index k = 0; k < at.size(); ++k) {
    const double h = 1e-6 * (1 + std::abs(at[k]));
    Eigen::VectorXd above = at, below = at;
    above[k] += h;
    below[k] -= h;
    matrix.col(k) = (conditions(above) - conditions(below)) / (2 * h);
  }
  return matrix;
}

double size_of(const Eigen::VectorXd& residual) {
  return residual.allFinite() ? residual.lpNorm<Eigen::Infinity>() : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<ElasticaPoint> integrate_elastica(const ElasticaPoint& start, const ElasticaLoad& load,
                                              double length, int steps) {
  std::vector<ElasticaPoint> points{start};
  points.reserve(static_cast<std::size_t>(steps) + 1);
  integrate(start, load, length, steps, [&](const ElasticaPoint& point) { points.push_back(point); });
  return points;
}

ElasticaPoint end_of_elastica(const ElasticaPoint& start, const ElasticaLoad& load, double length,
                              int steps) {
  ElasticaPoint end = start;
  integrate(start, load, length, steps, [&](const ElasticaPoint& point) { end = point; });
  return end;
}

std::optional<Eigen::VectorXd> solve_by_newton(const Conditions& conditions, Eigen::VectorXd guess,
                                               int iterations) {
  constexpr double rounding = 1e-12, slack = 1e-9;  // long shots magnify the rounding of their start
  Eigen::VectorXd residual = conditions(guess);
  for (int k = 0; k < iterations && size_of(residual) > rounding; ++k) {
    const Eigen::VectorXd step = derivatives(conditions, guess).partialPivLu().solve(residual);
    if (!step.allFinite()) return std::nullopt;
    double part = 1;
    Eigen::VectorXd next = conditions(guess - step);
    for (; size_of(next) >= size_of(residual) && part > 1e-3; next = conditions(guess - part * step))
      part /= 2;
    if (size_of(next) >= size_of(residual)) break;
    guess -= part * step;
    residual = next;
  }
  if (size_of(residual) > slack) return std::nullopt;
  return guess;
}

std::optional<Eigen::VectorXd> follow_solution(const FamilyConditions& conditions, Eigen::VectorXd solution,
                                               double from, double to) {
  constexpr int few = 7, most_steps = 300;
  Eigen::VectorXd slope = Eigen::VectorXd::Zero(solution.size());
  double at = from, step = (to - from) / 8;
  for (int k = 0; at != to; ++k) {
    if (k == most_steps || std::abs(step) < 1e-6 * std::abs(to - from)) return std::nullopt;
    const double next = std::abs(to - at) <= std::abs(step) ? to : at + step;
    const auto there = [&](const Eigen::VectorXd& unknowns) { return conditions(next, unknowns); };
    const auto found = solve_by_newton(there, solution + (next - at) * slope, few);
    const bool is_near = found && (*found - solution).norm() <= 0.3 * (1 + solution.norm());
    if (!is_near) {
      step = (next - at) / 3;
      continue;
    }
    slope = (*found - solution) / (next - at);
    solution = *found;
    at = next;
    step *= 2;
  }
  return solution;
}

double root_between(const std::function<double(double)>& f, double low, double high) {
  double at_low = f(low), at_high = f(high);
  assert((at_low <= 0) != (at_high <= 0));
  for (int k = 0; k < 200 && std::abs(high - low) > 1e-15 * (std::abs(low) + std::abs(high)); ++k) {
    if (at_high == 0) return high;
    const double next = high - at_high * (high - low) / (at_high - at_low);
    const double at_next = f(next);
    if ((at_next <= 0) != (at_high <= 0)) {
      low = high;
      at_low = at_high;
    } else {
      at_low /= 2;  // else one end would stay
    }
    high = next;
    at_high = at_next;
  }
  return high;
}

}  // namespace cloth::exact
