// What VBD's kernels know of the particles, on grids (grid_visits.h) and on any cloth (coloured_descent.h).
// Plain data only, for the reason given in grid_pass.h.
#pragma once

namespace cloth::kernels {

/// One number or one component of each particle, in the order of visits and with padding between.
struct DescentFields {
  int places = 0;            ///< with padding, a multiple of the widest register
  double* position[3] = {};  ///< m, in place
  double* shift[3] = {};     ///< m, in place: from where inertia takes each particle
  double* start[3] = {};     ///< m, at the start of the step; only read, and only with dampers
  double* before[3] = {};    ///< m: shifts of the iterate before the last; null: not needed
  double* drag[3] = {};      ///< (N/m)^1/2: b of W^-1/h^2 = M I + b b^T; null: none
  const double *mass = nullptr, *free = nullptr;  ///< N/m, M; 1 where free to move, else 0
  double damper = 0;                              ///< N/m, damping of every spring over the step
  /// Output: the largest squared move of a particle by a visit, and the sum of all, m^2.
  double largest_change = 0, squares = 0;
};

}  // namespace cloth::kernels
