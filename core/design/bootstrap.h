// Intervals by drawing from the sample with replacement (Efron 1979).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "design/quantile.h"
#include "design/random_choice.h"

namespace cloth {

inline constexpr std::size_t bootstrap_samples = 1000;

/// The 95 % interval of values that samples gave; not numbers where one of them is none.
inline std::pair<double, double> interval_of(std::vector<double> values) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (values.empty() || !std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
    return {none, none};
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.025), quantile(values, 0.975)};
}

}  // namespace cloth
