// Interpolation along a line of points from every second one, for multigrid: coarse point i lies at fine
// point 2 i. A grid's interpolation is that of its rows times that of its columns.
//
// Linear: half of either neighbour between two coarse points. Where a line has an even number of points, the
// last has its only neighbour's value.
// Cubic splines: the refinement of cubic B-splines (Lane and Riesenfeld 1980), 1/8 of the neighbours' and 3/4
// of a coarse point's own value where that lies, half of either neighbour's between two; beyond an end the
// coarse line goes on straight.
//
// The orders of interpolation and of its transpose must have a sum above the order of the equation (Hackbusch
// 1985, section 6.3): 4 for a sheet that bends, 2 for springs. Linear has 2 + 2: it bends a sheet at every
// second point only, so that a smooth bending comes out twice as stiff, four times on the next level, and so
// on. Splines have 4 + 4.
#pragma once

#include <vector>

#include "sparse/coarse_line.h"

namespace cloth {

enum class Interpolation { linear, cubic_splines };

class LineInterpolation {
 public:
  /// Of no points.
  LineInterpolation() = default;
  /// From every second one of `points`, or, where the line is not `halved`, from the points themselves.
  LineInterpolation(int points, bool halved, Interpolation interpolation);

  int coarse_points() const { return static_cast<int>(children_.size()); }
  /// Its lists stay as long as this does.
  CoarseLine line() const;

 private:
  std::vector<LineWeights> parents_, children_;
  const double* mask_ = nullptr;
  int regular_begin_ = 0, regular_end_ = 0;
};

}  // namespace cloth
