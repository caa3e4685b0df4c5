// The sweeps of multigrid for matrices of symmetric 3x3 blocks on a grid (sparse/block_multigrid.h), in
// single precision. Their time goes into reading blocks from beyond the first cache, not into arithmetic. So
// a sweep reads every block once, in the order in which it goes: a coupling is kept with the particle that
// the forward sweep solves later, and used there in both directions.
//
// Each row is cut into eight pieces of `groups` consecutive columns. Group g is column g of every piece, one
// in each lane of a register, and its neighbours are groups of the same lanes. The neighbour of a piece's
// last column is the next piece's first, in another lane: so the first and last `reach` groups are copied,
// moved by one lane, behind and before the row.
#pragma once

#include <cstddef>

#include "sparse/block_grid.h"
#include "sparse/coarse_line.h"

namespace cloth {

/// Column c of a row is particle c / groups of group c % groups. Group g of row r has its vector at r *
/// vector_row + g * vector_group, number n of lane l at 8 n + l.
struct BlockLevel {
  static constexpr int lanes = 8;
  static constexpr std::ptrdiff_t vector_group = 3 * lanes, block = 6 * lanes;
  int rows = 0, columns = 0, reach = 0;
  int groups = 0;  ///< per row; more than `reach`, so that no two particles of one group are coupled
  std::ptrdiff_t vector_row = 0, block_row = 0;
  /// Of each group the inverse of the diagonal's block, then those of its couplings: xx, xy, xz, yy, yz, zz,
  /// eight lanes each.
  const float* blocks = nullptr;
  float *x = nullptr, *b = nullptr, *r = nullptr;
  /// Groups whose couplings lie alike: each of the first and last `reach` of a row, and those between.
  struct Kind {
    std::ptrdiff_t first = 0;  ///< from a row's blocks to those of the first such group
    int couplings = 0;         ///< all with groups that the forward sweep solves earlier
    std::ptrdiff_t neighbour[most_couplings + most_reach] = {};  ///< from a group's vector to theirs
  };
  static constexpr int kinds = 2 * most_reach + 1;
  Kind kind[kinds];

  CLOTHLAB_INLINE int kind_of(int group) const {
    const int from_last = groups - 1 - group;
    return group < reach ? group : from_last < reach ? 2 * reach - from_last : reach;
  }
  /// Where a group has its blocks, from those of its row.
  CLOTHLAB_INLINE std::ptrdiff_t place_of_blocks(int group) const {
    const Kind& k = kind[kind_of(group)];
    const bool is_between = group >= reach && group < groups - reach;
    return k.first + (is_between ? (group - reach) * (1 + k.couplings) * block : 0);
  }
};

/// Interpolation P between a grid and the next coarser one.
struct BlockTransfer {
  CoarseLine rows, columns;
  float* scratch = nullptr;

  static std::size_t scratch_size(const BlockLevel& fine, const BlockLevel& coarse) {
    const int groups = fine.groups > coarse.groups ? fine.groups : coarse.groups;
    return static_cast<std::size_t>(9 * groups * BlockLevel::lanes + 2);
  }
};

/// How far apart the numbers of a field on the grid lie.
struct BlockField {
  std::ptrdiff_t next_row = 0, next_column = 0;
};

struct BlockCycleKernels {
  /// b, zero where a lane has no particle, of the three numbers of each particle.
  void (*set_right_side)(const BlockLevel& level, const BlockField& field, const double* const* of);
  /// x
  void (*get_solution)(const BlockLevel& level, const BlockField& field, double* const* to);
  /// A forward sweep of Gauss-Seidel for A x = b from x = 0, and r = b - A x: each group that is solved takes
  /// A_ij x_i from r of those before.
  void (*descend)(const BlockLevel& level);
  /// A backward sweep from x, whose copies must be up to date and are not kept so: each group that is solved
  /// takes A_ij x_i from b of those before in the forward order. Uses up b.
  void (*ascend)(const BlockLevel& level);
  /// coarse.b = P^T fine.r
  void (*restrict_residual)(const BlockLevel& fine, const BlockLevel& coarse, const BlockTransfer& transfer);
  /// fine.x += P coarse.x, with its copies.
  void (*add_correction)(const BlockLevel& fine, const BlockLevel& coarse, const BlockTransfer& transfer);

  CLOTHLAB_KERNEL_TABLE(BlockCycleKernels)
};

}  // namespace cloth
