// Galerkin's product of a matrix on a grid with the interpolation of its rows times that of its columns.
#pragma once

#include "sparse/block_grid.h"
#include "sparse/coarse_line.h"

namespace cloth {

struct BlockCoarsenKernels {
  /// Floats of scratch.
  static std::size_t scratch(const NaturalBlocks& fine, const NaturalBlocks& coarse) {
    return 6 * static_cast<std::size_t>((fine.reach + 1) * (2 * coarse.reach + 1)) *
           static_cast<std::size_t>(fine.rows) * static_cast<std::size_t>(coarse.columns);
  }
  /// coarse = P^T fine P, along the rows, then along the columns; also which couplings it has.
  void (*coarsen)(const NaturalBlocks& fine, const CoarseLine& rows, const CoarseLine& columns,
                  NaturalBlocks& coarse, float* scratch);

  CLOTHLAB_KERNEL_TABLE(BlockCoarsenKernels)
};

}  // namespace cloth
