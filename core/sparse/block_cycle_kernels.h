// The loops of multigrid for matrices of symmetric 3x3 blocks on a grid (sparse/block_multigrid.h), in single
// precision. The columns of a row are parted into three segments by their remainder modulo 3: couplings reach
// two columns at most, so that the particles of a segment are independent, and every neighbour of a segment
// is a run of another one. Around the segments lie zeros.
#pragma once

#include <cstddef>

#include "kernels/kernel_table.h"

namespace cloth {

/// Couplings to later particles, within two rows and columns; those to earlier ones are the same blocks.
struct BlockCoupling {
  int down = 0, right = 0;
};
inline constexpr int block_couplings = 12;
inline constexpr BlockCoupling block_coupling[block_couplings] = {
    {0, 1}, {0, 2}, {1, -2}, {1, -1}, {1, 0}, {1, 1}, {1, 2}, {2, -2}, {2, -1}, {2, 0}, {2, 1}, {2, 2}};

/// Where a neighbour's vector, and the block of the coupling, lie from those of a particle.
struct BlockNeighbour {
  std::ptrdiff_t vector = 0, block = 0;
};

/// The particles in column 3 t + colour of row r have their numbers at r * (numbers of a row) + number *
/// width + colour * segment + t: three of a vector, six of a block (xx, xy, xz, yy, yz, zz), six for each
/// coupling that there is.
struct BlockLevel {
  static constexpr int lanes = 16;
  int rows = 0, columns = 0, couplings = 0;
  std::ptrdiff_t segment = 0, width = 0;
  const float *blocks = nullptr, *inverse = nullptr;  ///< couplings; inverses of the diagonal's blocks
  float *x = nullptr, *b = nullptr, *r = nullptr;
  struct Colour {
    int earlier = 0, all = 0;  ///< neighbours: first those before a particle, row by row, colour by colour
    BlockNeighbour neighbour[2 * block_couplings];
  };
  Colour colour[3];
};

/// Blocks one number after the other: number n of coupling c (0: the diagonal, else block_coupling[c - 1]) of
/// particle p at (6 c + n) * particles + p.
struct NaturalBlocks {
  int rows = 0, columns = 0;
  float* numbers = nullptr;
  bool used[1 + block_couplings] = {};  ///< others are zero, and are not read
};

struct BlockCycleKernels {
  /// A forward sweep of Gauss-Seidel for A x = b from x = 0, and r = b - A x.
  void (*descend)(const BlockLevel& level);
  /// A backward sweep from x.
  void (*ascend)(const BlockLevel& level);
  /// coarse = P^T fine P along the rows, then along the columns: P interpolates linearly from every second
  /// particle. `between`: room for 15 * 6 numbers for every row of `fine` and column of `coarse`.
  void (*coarsen)(const NaturalBlocks& fine, const NaturalBlocks& coarse, float* between);

  CLOTHLAB_KERNEL_TABLE(BlockCycleKernels)
};

}  // namespace cloth
