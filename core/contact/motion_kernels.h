// What continuous contact asks of all particles in every step, by vectors: how far they move, whether a
// neighbour list still holds, and where two fields differ.
#pragma once

#include "kernels/kernel_table.h"

namespace cloth {

/// The components of consecutive particles in a Vec3Field.
struct Components {
  const double* x;
  const double* y;
  const double* z;

  Components from(long first) const { return {x + first, y + first, z + first}; }
};

struct MotionKernels {
  /// Writes the distance of each particle's two positions, in m, and returns the largest; 0 of none.
  double (*find_lengths)(Components from, Components to, long count, double* lengths);
  /// (to - from) / step of each number.
  void (*find_mean_speed)(const double* to, const double* from, double step, long count, double* speed);
  /// Whether moved + range is at most `allowed`, and moved + most at most `beside`, everywhere.
  bool (*are_within)(const double* moved, const double* range, double most, const double* allowed,
                     const double* beside, long count);
  /// Whether two runs of numbers differ in any bit.
  bool (*differ)(const double* a, const double* b, long count);
  bool (*are_finite)(const double* values, long count);

  CLOTHLAB_KERNEL_TABLE(MotionKernels)
};

}  // namespace cloth
