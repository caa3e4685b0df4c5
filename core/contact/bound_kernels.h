// Lower bounds of the distances of many pairs of features, by vectors in single precision. For any direction
// n the distance of two convex features is at least how far they are apart along it, (min n.a - max n.b)/|n|
// over their vertices a and b: rounding in the choice of n makes a bound weaker, but not wrong. What rounding
// of coordinates and products may add is taken off.
#pragma once

#include "kernels/kernel_table.h"

namespace cloth {

/// m, from an origin near the cloth; the fourth number is 0.
struct alignas(16) RoundedPoint {
  float of[4] = {};
};

/// The vertices of a pair.
struct PairVertices {
  int of[4];
};

/// `bounds`: m, one for each pair; may be negative, and is -infinity where a coordinate is above 1e5 m.
struct BoundKernels {
  /// Of the segments between near[of[0]] and near[of[1]], and far[of[2]] and far[of[3]].
  void (*of_segments)(const RoundedPoint* near, const RoundedPoint* far, const PairVertices* pairs, int count,
                      float* bounds);
  /// Of points[of[0]] and the triangle of corners[of[1]], [of[2]] and [of[3]].
  void (*of_triangles)(const RoundedPoint* points, const RoundedPoint* corners, const PairVertices* pairs,
                       int count, float* bounds);

  CLOTHLAB_KERNEL_TABLE(BoundKernels)
};

}  // namespace cloth
