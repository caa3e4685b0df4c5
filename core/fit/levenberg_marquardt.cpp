#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "fit/fit_space.h"

namespace cloth {
namespace {

constexpr double smallest_gain = 1e-8;    // of chi squared, that a further step is worth
constexpr double negligible_gain = 0.01;  // a tenth of a standard error: no failure to stop there
constexpr double small_gain = 1e-3;  // of a step; three such in turn are an end: rough outputs go no lower
constexpr int most_small_gains = 3;
constexpr double longest_step = 1;  // of a coordinate: a factor of e, or the whole range
constexpr double most_damping = 1e12;

/// The equations of a step: J'J and J'r of the targets that are fitted.
struct Slopes {
  Eigen::MatrixXd normal;
  Eigen::VectorXd gradient;  // half of chi squared's

  Slopes(FitSpace& space, const Eigen::VectorXd& u, const Eigen::VectorXd& residuals) {
    const Eigen::MatrixXd jacobian = space.fitted_rows(space.jacobian(u, residuals));
    normal = jacobian.transpose() * jacobian;
    gradient = jacobian.transpose() * space.fitted_rows(residuals);
    for (Eigen::Index j = 0; j < u.size(); ++j) {  // what a bound holds takes no part
      const auto k = static_cast<std::size_t>(j);
      const bool held =
          (u[j] <= space.low(k) && gradient[j] > 0) || (u[j] >= space.high(k) && gradient[j] < 0);
      if (!held) continue;
      normal.row(j).setZero();
      normal.col(j).setZero();
      gradient[j] = 0;
    }
  }

  Eigen::VectorXd step(double damping) const {
    const double floor = 1e-12 * std::max(normal.diagonal().maxCoeff(), 1e-300);
    Eigen::MatrixXd damped = normal;
    for (Eigen::Index j = 0; j < damped.rows(); ++j) damped(j, j) += damping * normal(j, j) + floor;
    const Eigen::VectorXd whole = -damped.ldlt().solve(gradient);
    return whole * std::min(1.0, longest_step / std::max(whole.cwiseAbs().maxCoeff(), 1e-300));
  }

  /// By which chi squared falls, were the residuals linear.
  double gain(const Eigen::VectorXd& step) const { return -2 * gradient.dot(step) - step.dot(normal * step); }
};

}  // namespace

DescentEnd levenberg_marquardt(FitSpace& space, const Eigen::VectorXd& start,
                               const Eigen::VectorXd& residuals, std::size_t max_iterations) {
  DescentEnd at{FitStatus::max_iterations, start, residuals, space.chi_squared(residuals)};
  double damping = 1e-3, growth = 2;
  int small_gains = 0;
  Slopes slopes(space, at.u, at.residuals);
  for (std::size_t k = 0; k < max_iterations; ++k) {
    const Eigen::VectorXd next = space.clamped(at.u + slopes.step(damping));
    const double promised = slopes.gain(next - at.u);
    const bool is_done = !(promised > smallest_gain) || small_gains == most_small_gains;
    if (is_done || damping > most_damping) {
      const double left = slopes.gain(slopes.step(0));
      at.status = is_done && left < negligible_gain ? FitStatus::converged : FitStatus::stalled;
      return at;
    }
    const auto found = space.residuals(next);
    const double chi = found ? space.chi_squared(*found) : INFINITY;
    const double ratio = (at.chi_squared - chi) / promised;
    small_gains = at.chi_squared - chi < small_gain && promised < negligible_gain ? small_gains + 1 : 0;
    if (!(ratio > 1e-4)) {
      damping *= growth;
      growth *= 2;
      continue;
    }
    at.u = next, at.residuals = *found, at.chi_squared = chi;
    damping *= std::max(1.0 / 3, 1 - std::pow(2 * std::min(ratio, 1.0) - 1, 3));
    growth = 2;
    slopes = Slopes(space, at.u, at.residuals);
  }
  return at;
}

}  // namespace cloth
