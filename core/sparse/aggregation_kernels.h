// The loops of multigrid by smoothed aggregation (sparse/aggregation_multigrid.h), in single precision, for
// blocks of 3 rows, as on the finest level, and of 6.
//
// Blocks of a matrix are square and stand column by column, one after the other. Those that lead to the next
// coarser level have 6 columns and stand row by row, each row in `row_width` numbers. Vectors have a whole
// register for each block: 4 numbers for 3 rows, 8 for 6. Readers take whole registers: every array has
// `padding` further numbers at its end.
#pragma once

#include "kernels/kernel_table.h"

namespace cloth {

/// Rows as in SparsePattern.
struct RowIndex {
  int rows = 0;
  const int *begin = nullptr, *column = nullptr;
};

struct AggregationLevel {
  RowIndex index;
  const int* diagonal = nullptr;  ///< entry of each row
  int reach = 0;                  ///< the furthest column from its row
  const float *blocks = nullptr, *inverse = nullptr;
  float *x = nullptr, *b = nullptr, *r = nullptr;
};

/// Of a level to the next coarser one.
struct AggregationTransfer {
  RowIndex prolongator, image;  ///< P and A P
  const int* aggregate = nullptr;
  const float* basis = nullptr;  ///< of each point: the tentative prolongator
  float* p = nullptr;
  float* row = nullptr;  ///< scratch: a row of A P
  int* place = nullptr;  ///< scratch: one for each coarse point
  RowIndex coarse;
  const int* coarse_diagonal = nullptr;  ///< entry of each row
  const int* mirrored = nullptr;  ///< for each entry of the coarse matrix the one of its transposed place
  float* sums = nullptr;          ///< scratch: `sum_width` for each entry of the coarse matrix
  float* coarse_blocks = nullptr;
};

struct AggregationKernels {
  static constexpr int modes = 6, row_width = 8, sum_width = modes * row_width, padding = 16;
  /// For blocks of `size` rows.
  struct Loops {
    /// A forward sweep of Gauss-Seidel for A x = b from x = 0, and r = b - A x.
    void (*descend)(const AggregationLevel& level);
    /// A backward sweep from x.
    void (*ascend)(const AggregationLevel& level);
    /// coarse b = P^T r
    void (*restrict_residual)(const AggregationLevel& level, const AggregationTransfer& transfer,
                              float* coarse);
    /// x += P coarse x
    void (*add_correction)(const AggregationLevel& level, const AggregationTransfer& transfer,
                           const float* coarse);
    /// P = (1 - weight D^-1 A) times the tentative prolongator, D the blocks of A's diagonal. Points that A
    /// couples with aggregates which P has no entry for count as moving with the point itself: so A is
    /// filtered.
    void (*smooth)(const AggregationLevel& level, const AggregationTransfer& transfer, float weight);
    /// P^T A P
    void (*coarsen)(const AggregationLevel& level, const AggregationTransfer& transfer);
  };
  Loops three, six;

  CLOTHLAB_KERNEL_TABLE(AggregationKernels)
};

}  // namespace cloth
