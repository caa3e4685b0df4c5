// Round numbers: a few digits times a power of ten, as axes, grids and scales have them.
#pragma once

#include <cmath>
#include <initializer_list>

namespace cloth {

/// The smallest of `digits`, ascending from 1 and below 10, times a power of ten that is not below `value` >
/// 0; less of it than `slack` times the value is no excess.
inline double rounded_up(double value, std::initializer_list<double> digits = {1.0, 2.0, 5.0},
                         double slack = 1e-9) {
  const double power = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
  for (const double digit : digits)
    if (digit * power >= value * (1 - slack)) return digit * power;
  return 10 * power;
}

/// Between the lines of a grid over something of this size (m): some 16 of them.
inline double grid_step_for(double size) {
  return rounded_up((size > 1e-6 ? size : 1e-6) / 16);
}

}  // namespace cloth
