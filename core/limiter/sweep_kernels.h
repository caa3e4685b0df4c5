// The innermost loops of the limiter, compiled for several instruction sets and chosen at run time. Only
// subtraction, multiplication, division, square root and comparison are used, each rounded correctly and
// never contracted, so that every set gives the same bits.
#pragma once

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

/// Springs s = 0 .. count-1, each joining particle first + s * stride to the one `offset` further.
struct SpringRow {
  int first = 0;
  int count = 0;
  int stride = 1;
  int offset = 1;
};

struct SweepKernels {
  const char* instruction_set;

  /// The largest squared length in m^2 of the springs longer than `limit` (m), 0 if there are none.
  /// Precondition: stride 1. What is not a number is passed over.
  double (*longest)(const SpringRow& row, double limit, ConstPoints points);

  /// Takes `relaxation` times the excess from every spring longer than `limit` (m), half of it at each end.
  /// Returns the largest squared length of these before, 0 if there were none. Precondition: no two of the
  /// springs share a particle; the stride is 1, or 2 and the offset 1.
  double (*shorten)(const SpringRow& row, double limit, double relaxation, Points points);

  /// Sum of (l1 - L)^2 - (l0 - L)^2 in m^2, l0 and l1 the lengths before and after, L the rest length.
  /// Precondition: stride 1. Summed in eight parts whatever the instruction set.
  double (*stretching)(const SpringRow& row, double rest_length, ConstPoints before, ConstPoints after);
};

// Each in its own translation unit; null where this program was not built for such a processor.
const SweepKernels* plain_sweep_kernels();
const SweepKernels* sse2_sweep_kernels();
const SweepKernels* avx2_sweep_kernels();
const SweepKernels* avx512_sweep_kernels();

}  // namespace cloth
