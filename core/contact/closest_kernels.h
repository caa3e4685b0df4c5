// Closest points of many segments, and of many points and triangles (geometry/closest_points.h), by vectors:
// the same operations in the same order, never contracted, so that every instruction set gives the same bits
// as the functions for one pair.
#pragma once

#include "kernels/kernel_table.h"

namespace cloth {

/// Pairs side by side, so that a loop over them is one over vectors.
struct ClosestBlock {
  static constexpr int size = 32;

  /// m: x, y and z of the ends a, b, c, d of two segments, or of a point and a triangle a, b, c.
  alignas(64) double point[4][3][size];

  /// Of the second ends of both segments, or of the triangle's vertices.
  alignas(64) double weight[3][size];
  alignas(64) double separation[3][size];     ///< m, from the second feature to the first
  alignas(64) double squared_distance[size];  ///< m^2
  /// 0: nearly parallel or slender, which the function for one pair must be asked for; else 1.
  alignas(64) double is_sound[size];
};

struct ClosestKernels {
  void (*of_segments)(ClosestBlock& block);
  void (*on_triangles)(ClosestBlock& block);

  CLOTHLAB_KERNEL_TABLE(ClosestKernels)
};

}  // namespace cloth
