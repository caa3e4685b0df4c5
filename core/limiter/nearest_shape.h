// The nearest shape that satisfies the deformation rate. The shapes x with |x_j - x_i| <= (1 + rate) L for
// every limited spring form a convex set, so that the one nearest to a given x0 is unique:
//
//     minimise 1/2 sum w_i |x_i - x0_i|^2 + rho/2 sum e_s^2   where   |x_j - x_i| - (1 + rate) L_s <= e_s,
//
// w_i the particle's mass over the mean mass, pinned particles fixed. rho is so large that the excesses e_s
// are far below the tolerance; they regularise redundant constraints. Where the pins make the rate
// unreachable, a smaller rho gives the compromise of least violation. Solved by Mehrotra's
// predictor-corrector interior point method (Nocedal and Wright 2006, 16.6 and 19), with one sparse Cholesky
// factorisation (sparse/block_cholesky.h) per iteration.
#pragma once

#include <vector>

#include "limiter/tension_springs.h"

namespace cloth {

struct NearestShapeReport {
  int iterations = 0;  ///< one factorisation each
  double excess = 0;   ///< largest (|d| - limit)/rest length that is left; 0 if no spring exceeds its limit
  bool converged = false;  ///< the conditions of a minimum hold; with unreachable pins an excess remains
};

class NearestShape {
 public:
  static constexpr int max_iterations = 60;  ///< in each of at most `max_rounds` rounds
  static constexpr int max_rounds = 4;

  NearestShape(const Deformation& deformation, const ClothSystem& system);

  /// Moves `position` to the nearest shape, or without convergence to the best found, never with a larger
  /// excess than before. The result depends on the arguments only. `reachable` false skips the search for a
  /// shape without excess.
  NearestShapeReport find(const ClothSystem& system, double tolerance, Vec3Field& position,
                          bool reachable = true);

  /// Springs with an end that is free, and their multipliers in the last `find`, in m: every free particle
  /// has w (x - x0) = sum of multiplier * direction toward the spring's other end.
  const std::vector<TensionSpring>& springs() const { return springs_; }
  const std::vector<double>& multipliers() const { return multipliers_; }

 private:
  std::vector<TensionSpring> springs_;
  std::vector<double> multipliers_;
};

}  // namespace cloth
