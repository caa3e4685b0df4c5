// Symmetric 3x3 blocks of a matrix on a grid, number by number, as multigrid adds to them and coarsens them
// (sparse/block_multigrid.h). A coupling to a later particle, at most `reach` rows and columns away, is kept
// with the earlier one; that of the later to the earlier particle is the same block.
#pragma once

#include <cstddef>

#include "kernels/kernel_table.h"

namespace cloth {

inline constexpr int most_reach = 3, most_couplings = 2 * most_reach * (most_reach + 1);

/// Where the other particle lies. NaturalBlocks keep those with down > 0, or down = 0 and right > 0.
struct BlockCoupling {
  int down = 0, right = 0;
};

/// Number n of coupling c (0: the diagonal, xx, xy, xz, yy, yz, zz) of particle p lies at
/// (6 c + n) * particles + p.
struct NaturalBlocks {
  int rows = 0, columns = 0, reach = 0;
  float* numbers = nullptr;
  bool used[1 + most_couplings] = {};  ///< others are zero, and are not read

  CLOTHLAB_INLINE int couplings() const { return 2 * reach * (reach + 1); }
  CLOTHLAB_INLINE int number_of(BlockCoupling c) const { return c.down * (2 * reach + 1) + c.right; }
  CLOTHLAB_INLINE BlockCoupling coupling(int number) const {
    const int down = (number + reach) / (2 * reach + 1);
    return {down, number - down * (2 * reach + 1)};
  }
  CLOTHLAB_INLINE std::ptrdiff_t particles() const { return static_cast<std::ptrdiff_t>(rows) * columns; }
  CLOTHLAB_INLINE float* blocks_of(int number) const { return numbers + 6 * number * particles(); }
};

}  // namespace cloth
