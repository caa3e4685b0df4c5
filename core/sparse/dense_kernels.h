// The dense arithmetic of sparse Cholesky factors, in column-major order. Only lower triangles count: what
// stands above a diagonal has no meaning. Every entry is the same sum in the same order, without fused
// operations, so that every instruction set gives the same bits.
#pragma once

#include <cstddef>

#include "kernels/kernel_table.h"

namespace cloth {

/// A column-major array: entry (row, column) at data[row + column * stride].
struct DenseBlock {
  double* data;
  std::size_t stride;
};

/// One number of each of up to four right-hand sides, side by side.
struct Quad {
  double of[4] = {};
};

struct DenseKernels {
  /// Replaces the first `width` of `height` rows by the factor L of L L^T, and the rows below by their part
  /// of the factor, A L^-T. False where a pivot is not positive.
  bool (*factorise_columns)(DenseBlock front, int height, int width);

  /// update -= A A^T for the lower triangle; A has `size` rows and `width` columns.
  void (*subtract_square)(DenseBlock update, DenseBlock a, int size, int width);

  /// With columns so factored: own <- L^-1 own for the first `width` numbers, below -= A own for the others.
  void (*eliminate)(DenseBlock front, int height, int width, double* own, double* below);
  void (*eliminate_quads)(DenseBlock front, int height, int width, Quad* own, Quad* below);

  /// own <- L^-T (own - A^T below)
  void (*substitute)(DenseBlock front, int height, int width, double* own, const double* below);
  void (*substitute_quads)(DenseBlock front, int height, int width, Quad* own, const Quad* below);

  CLOTHLAB_KERNEL_TABLE(DenseKernels)
};

}  // namespace cloth
