// Products of block matrices and vectors, for iterative solvers. Sums are taken in the order of cloth/sums.h,
// without fused operations, so that every instruction set gives the same bits.
#pragma once

#include <cstddef>

#include "kernels/kernel_table.h"

namespace cloth {

/// The six numbers of symmetric 3 x 3 blocks, each a contiguous run.
struct BlockRows {
  const double *xx, *xy, *xz, *yy, *yz, *zz;
};
struct VectorRows {
  double *x, *y, *z;
};
struct ConstVectorRows {
  const double *x, *y, *z;
};

struct VectorKernels {
  /// Springs that add_springs() takes at once, at most.
  static constexpr int max_springs = 128;

  /// product = B direction, block by block
  void (*multiply_blocks)(BlockRows blocks, ConstVectorRows direction, VectorRows product, std::size_t count);
  /// For springs from particle s to particle s + offset with block B: adds B (d_s - d_(s + offset)) to the
  /// product of the first end and subtracts it from that of the second.
  void (*add_springs)(BlockRows blocks, ConstVectorRows direction, VectorRows product, std::ptrdiff_t offset,
                      int count);
  double (*dot)(const double* a, const double* b, std::size_t count);
  /// to += scale from
  void (*add_multiple)(double scale, const double* from, double* to, std::size_t count);
  /// to = scale to + from
  void (*scale_and_add)(double scale, const double* from, double* to, std::size_t count);

  CLOTHLAB_KERNEL_TABLE(VectorKernels)
};

}  // namespace cloth
