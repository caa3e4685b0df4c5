// The classical Runge-Kutta method of order four (Kutta 1901). Data only, see grid_pass.h.
#pragma once

namespace cloth {

/// Stage s stands `node` h after the begin of the step, along the slope of stage s - 1, and its slope counts
/// with `weight`.
struct KuttaStage {
  double node, weight;
};
inline constexpr int kutta_stages = 4;
inline constexpr KuttaStage kutta[kutta_stages] = {
    {0, 1.0 / 6}, {0.5, 1.0 / 3}, {0.5, 1.0 / 3}, {1, 1.0 / 6}};

}  // namespace cloth
