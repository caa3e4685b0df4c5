// The dense arithmetic of sparse Cholesky factors, in column-major order. Only lower triangles count; what
// stands above a diagonal is neither read as a result nor kept.
//
// Compiled for AVX-512, AVX2 and plain x86-64, chosen by what the processor has. Every entry is the same sum
// in the same order, without fused operations, so that all give the same bits.
#pragma once

#include <cstddef>
#include <vector>

namespace cloth {

/// A column-major array: entry (row, column) at data[row + column * stride].
struct DenseBlock {
  double* data;
  std::size_t stride;
};

struct DenseKernels {
  const char* instruction_set;

  /// Turns the first `width` of `height` rows into L of L L^T and those below into what is left of them, L^-T
  /// to the right. False where a pivot is not positive.
  bool (*factorise_columns)(DenseBlock front, int height, int width);

  /// update -= A A^T for the lower triangle; A has `size` rows and `width` columns.
  void (*subtract_square)(DenseBlock update, DenseBlock a, int size, int width);
};

/// Those that this processor has: the plain ones first, the widest last.
const std::vector<DenseKernels>& dense_kernels();
/// The widest that may run.
const DenseKernels& chosen_dense_kernels();

/// One number of each of up to four right-hand sides, side by side.
struct Quad {
  double of[4] = {};
};

/// With columns so factored: own <- L^-1 own for the first `width` numbers, below -= A own for the others.
void eliminate(DenseBlock front, int height, int width, double* own, double* below);
void eliminate(DenseBlock front, int height, int width, Quad* own, Quad* below);

/// own <- L^-T (own - A^T below)
void substitute(DenseBlock front, int height, int width, double* own, const double* below);
void substitute(DenseBlock front, int height, int width, Quad* own, const Quad* below);

}  // namespace cloth
