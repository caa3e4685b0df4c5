// A fit in its coordinates: logarithms and parts of ranges instead of values, residuals in sigmas instead of
// outputs, runs counted.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "fit/fit.h"

namespace cloth {

/// Thrown where the caller asked for a stop; fit() catches it.
struct FitStopped {};

class FitSpace {
 public:
  FitSpace(const FitProblem& problem, const FitOptions& options);

  std::size_t dimensions() const { return problem_.parameters.size(); }
  double low(std::size_t j) const { return low_[j]; }
  double high(std::size_t j) const { return high_[j]; }
  std::vector<double> values(const Eigen::VectorXd& u) const;
  Eigen::VectorXd coordinates(const std::vector<double>& values) const;
  /// Of a point in the unit cube.
  Eigen::VectorXd between(const std::vector<double>& unit) const;
  Eigen::VectorXd clamped(const Eigen::VectorXd& u) const;

  /// (simulated - measured)/sigma of every target, those held out too; nullopt where one has no value.
  using Residuals = std::optional<Eigen::VectorXd>;
  std::vector<Residuals> residuals(const std::vector<Eigen::VectorXd>& points);
  Residuals residuals(const Eigen::VectorXd& u) { return residuals(std::vector{u}).front(); }

  /// d residual/d u by central differences, all runs in one batch; at a bound, or where one of the two runs
  /// failed, by a difference to one side. A column is 0 where both failed. `centre`: the residuals at u.
  Eigen::MatrixXd jacobian(const Eigen::VectorXd& u, const Eigen::VectorXd& centre);

  /// Of the targets that are fitted.
  double chi_squared(const Eigen::VectorXd& residuals) const;
  Eigen::MatrixXd fitted_rows(const Eigen::MatrixXd& all) const;

  std::size_t evaluations() const { return evaluations_; }
  std::size_t failed() const { return failed_; }
  const FitProgress& best() const { return best_; }

 private:
  const FitProblem& problem_;
  const FitOptions& options_;
  std::vector<double> low_, high_;
  double step_;
  std::size_t evaluations_ = 0, failed_ = 0;
  FitProgress best_;
};

/// Where a descent ended.
struct DescentEnd {
  FitStatus status = FitStatus::converged;
  Eigen::VectorXd u, residuals;
  double chi_squared = 0;
};

/// Levenberg-Marquardt (Levenberg 1944, Marquardt 1963) with Nielsen's damping (1999) from a point that has
/// residuals; bounds by leaving out what pushes against them. Ends where a step would lower chi squared by
/// less than 1e-8.
DescentEnd levenberg_marquardt(FitSpace& space, const Eigen::VectorXd& start,
                               const Eigen::VectorXd& residuals, std::size_t max_iterations);

/// Subplex (Rowan 1990) of NLopt (Johnson), which only compares values of chi squared.
DescentEnd derivative_free(FitSpace& space, const Eigen::VectorXd& start, const Eigen::VectorXd& residuals,
                           std::size_t max_evaluations);

}  // namespace cloth
