// Quantiles of a few measured values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace cloth {

/// Interpolated between neighbours. Precondition: `sorted` is ascending and not empty, `part` in [0, 1].
inline double quantile(const std::vector<double>& sorted, double part) {
  const double place = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace cloth
