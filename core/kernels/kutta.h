// The classical Runge-Kutta method of order four (Kutta 1901). Data only, see grid_pass.h.
#pragma once

namespace cloth {

/// Stage s is at the time t + node h: the state plus node h times the slope of stage s - 1. The step adds
/// weight h times its slope.
struct KuttaStage {
  double node, weight;
};
inline constexpr int kutta_stages = 4;
inline constexpr KuttaStage kutta[kutta_stages] = {
    {0, 1.0 / 6}, {0.5, 1.0 / 3}, {0.5, 1.0 / 3}, {1, 1.0 / 6}};

}  // namespace cloth
