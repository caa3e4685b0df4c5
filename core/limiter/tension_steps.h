// Constants that the implementations of TensionRounds share.
#pragma once

#include <algorithm>

#include "limiter/tension_rounds.h"

namespace cloth {

/// Share of the diagonal of J W J^T that is added to it, because redundant springs make that matrix singular.
inline constexpr double least_ridge = 3e-6;     ///< along a line, above what floats round
inline constexpr double together_ridge = 1e-3;  ///< all tensions at once; less only makes iterations more
inline double ridge_of(const TensionTask& task) {
  return std::max(together_ridge, task.softness);
}

/// Conjugate gradients end at this share of the first residual, or of the tolerance.
inline constexpr double enough_of_residual = 0.5, enough_of_tolerance = 0.3;
inline constexpr int most_cg_iterations = 6;

/// Where the clipped step does not reduce C, this share of C over the diagonal is taken.
inline constexpr double steepest_share = 0.25;

}  // namespace cloth
