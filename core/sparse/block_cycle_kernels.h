// The loops of multigrid for matrices of symmetric 3x3 blocks on a grid (sparse/block_multigrid.h), in single
// precision. The columns of a row are parted into segments, one for each colour: their remainder modulo one
// more than the columns that couplings reach. So the particles of a segment are independent, and every
// neighbour of a segment is a run of another one. Around the segments lie zeros.
#pragma once

#include <cstddef>

#include "sparse/block_grid.h"

namespace cloth {

/// Where a neighbour's vector, and the block of the coupling, lie from those of a particle.
struct BlockNeighbour {
  std::ptrdiff_t vector = 0, block = 0;
};

/// The particles in column colours t + colour of row r have their numbers at r * (numbers of a row) + number
/// * width + colour * segment + t: three of a vector, six of a block (xx, xy, xz, yy, yz, zz), six for each
/// coupling that there is.
struct BlockLevel {
  static constexpr int lanes = 16;
  int rows = 0, columns = 0, couplings = 0, colours = 0;
  std::ptrdiff_t segment = 0, width = 0;
  const float *blocks = nullptr, *inverse = nullptr;  ///< couplings; inverses of the diagonal's blocks
  float *x = nullptr, *b = nullptr, *r = nullptr;
  struct Colour {
    int earlier = 0, all = 0;  ///< neighbours: first those before a particle, row by row, colour by colour
    BlockNeighbour neighbour[2 * most_couplings];
  };
  Colour colour[most_reach + 1];
};

struct BlockCycleKernels {
  /// A forward sweep of Gauss-Seidel for A x = b from x = 0, and r = b - A x.
  void (*descend)(const BlockLevel& level);
  /// A backward sweep from x.
  void (*ascend)(const BlockLevel& level);

  CLOTHLAB_KERNEL_TABLE(BlockCycleKernels)
};

}  // namespace cloth
