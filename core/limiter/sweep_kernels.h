// The innermost loops of the limiter's sweeps. Only subtraction, multiplication, division, square root and
// comparison are used, each rounded correctly and never contracted, so that every instruction set gives the
// same bits.
#pragma once

#include "kernels/kernel_table.h"

namespace cloth {

/// Positions in m, three contiguous runs.
struct Points {
  double* x;
  double* y;
  double* z;
};
struct ConstPoints {
  const double* x;
  const double* y;
  const double* z;
};

/// Springs s = 0 .. count-1, each joining particle first + s * stride to particle first + s * stride +
/// offset.
struct SpringRow {
  int first = 0;
  int count = 0;
  int stride = 1;
  int offset = 1;
};

struct SweepKernels {
  /// The largest squared length in m^2 of the springs longer than `limit` (m), 0 if there are none.
  /// Precondition: stride 1. NaN lengths are ignored.
  double (*longest)(const SpringRow& row, double limit, ConstPoints points);

  /// Takes `relaxation` times the excess from every spring longer than `limit` (m), half of it at each end.
  /// Returns the largest squared length of these before, 0 if there were none. Precondition: no two of the
  /// springs share a particle.
  double (*shorten)(const SpringRow& row, double limit, double relaxation, Points points);

  CLOTHLAB_KERNEL_TABLE(SweepKernels)
};

}  // namespace cloth
