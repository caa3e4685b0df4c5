// What the kinds of TensionRounds share: the numbers of their steps.
#pragma once

#include <algorithm>

#include "limiter/tension_rounds.h"

namespace cloth {

/// Of a diagonal of J W J^T, added to it: springs that say the same thing twice make that matrix singular.
inline constexpr double least_ridge = 3e-6;     ///< along a line, above what floats round
inline constexpr double together_ridge = 1e-3;  ///< all tensions at once; less only makes iterations more
inline double ridge_of(const TensionTask& task) {
  return std::max(together_ridge, task.softness);
}

/// Conjugate gradients end at this share of the first residual, or of the tolerance.
inline constexpr double enough_of_residual = 0.5, enough_of_tolerance = 0.3;
inline constexpr int most_gradients = 6;

/// Where even the clipped step would not do, this share of C over the diagonal is taken.
inline constexpr double steepest_share = 0.25;

}  // namespace cloth
