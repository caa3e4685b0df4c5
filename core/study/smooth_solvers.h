// Two solvers of y' = f(t, y) to near rounding, of different families, for references alone: no method that
// they judge is one of them.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/study_progress.h"

namespace cloth {

/// dy = f(t, y); dy has y's size.
using Derivative = std::function<void(double t, const Eigen::VectorXd& y, Eigen::VectorXd& dy)>;

/// Extrapolation of the modified midpoint rule in even powers of the step, with order and step control
/// (Gragg 1965; Bulirsch and Stoer 1966; Hairer et al., I, II.9): columns are added until the
/// last two agree.
class Extrapolation {
 public:
  /// `tolerance` is of |error_k| / scale_k in each step; 1e-13 is within reach.
  Extrapolation(double tolerance, Eigen::VectorXd scale) : tolerance_(tolerance), scale_(std::move(scale)) {}

  /// y(begin) becomes y(end); the reason if it cannot: the step would vanish, y is not finite, or "stopped",
  /// which is looked at before each step.
  std::optional<std::string> advance(const Derivative& f, double begin, double end, Eigen::VectorXd& y,
                                     const StopTest& stop = {});

 private:
  void midpoint_rule(const Derivative& f, double begin, double step, int parts, const Eigen::VectorXd& y,
                     Eigen::VectorXd& result);
  double try_step(const Derivative& f, double begin, double step, const Eigen::VectorXd& y, int& columns);

  double tolerance_;
  Eigen::VectorXd scale_;
  double step_ = 0;  ///< s, the next to try; 0: none known
  std::vector<Eigen::VectorXd> table_;
  Eigen::VectorXd slope_, previous_, middle_, next_, derivative_;
};

/// Gauss-Legendre collocation with six stages, order 12, symmetric (Hairer et al., I, II.7;
/// Kuntzmann 1961), in equal steps. The stages are found by fixed-point iteration from the last step's
/// polynomial, until nothing changes but rounding: steps must be short against the fastest motion.
class Collocation {
 public:
  static constexpr int stages = 6;
  explicit Collocation(Eigen::VectorXd scale);

  /// `steps` equal steps; the reason if the iteration does not converge, or "stopped".
  std::optional<std::string> advance(const Derivative& f, double begin, double end, int steps,
                                     Eigen::VectorXd& y, const StopTest& stop = {});

 private:
  bool solve_stages(const Derivative& f, double begin, double step, const Eigen::VectorXd& y);

  Eigen::VectorXd scale_;
  Eigen::Matrix<double, stages, 1> nodes_, weights_;
  Eigen::Matrix<double, stages, stages> inner_;    ///< a_ij
  Eigen::Matrix<double, stages, stages> forward_;  ///< a stage's polynomial at the next step's nodes
  Eigen::Matrix<double, Eigen::Dynamic, stages> slopes_, guess_;
  Eigen::VectorXd stage_, derivative_;
  double last_step_ = 0;
};

}  // namespace cloth
