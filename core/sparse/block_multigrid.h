// A preconditioner for symmetric, positive definite matrices of symmetric 3x3 blocks on a grid whose
// couplings reach two rows and two columns at most: one V-cycle of multigrid in single precision, with a
// forward sweep of block Gauss-Seidel before and a backward one after the correction of the coarser grid, so
// that the cycle is symmetric; interpolation from every second row and column, Galerkin's matrices, whose
// blocks are symmetric as well, and the inverse of the coarsest (Trottenberg, Oosterlee and Schueller 2001).
// Rows are in order, the columns of a row in eight pieces at once, one for each lane of a group, each piece
// in order (sparse/block_cycle_kernels.h). A grid with more rows than columns is turned, since the loops go
// along the columns of a row.
//
//     BlockMultigrid multigrid;
//     multigrid.begin(rows, columns, Interpolation::linear);
//     multigrid.add_to_diagonal(...); multigrid.add_coupling(...);
//     if (multigrid.prepare()) multigrid.solve(residual, correction);
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/vec3_field.h"
#include "sparse/block_cycle_kernels.h"
#include "sparse/line_interpolation.h"

namespace cloth {

class BlockMultigrid {
 public:
  /// Sets the matrix to zero. Particle r * columns + c.
  void begin(int rows, int columns, Interpolation interpolation);

  /// xx, xy, xz, yy, yz, zz of the blocks of consecutive particles from `first` on are added.
  void add_to_diagonal(std::size_t first, std::size_t count, const std::array<const double*, 6>& blocks) {
    add_blocks(0, first, count, 1, blocks);
  }
  /// The blocks of `count` couplings between particles first + k and first + k + offset, times `scale`.
  /// `offset` is positive. False, and nothing added, where they lie too far apart.
  bool add_couplings(std::size_t first, std::size_t count, int offset, double scale,
                     const std::array<const double*, 6>& blocks);
  /// The same where every block is `value` times the identity.
  void add_to_diagonal(std::size_t first, std::size_t count, double value) {
    add_identity(0, first, count, value);
  }
  bool add_couplings(std::size_t first, std::size_t count, int offset, double value);
  /// Takes a particle out: its row and column become zero.
  void fix(std::size_t particle);

  /// Makes the coarser matrices. False where the coarsest is not positive definite, or not finite.
  bool prepare();

  /// correction = one cycle from zero for A x = residual. Zero on fixed particles where the residual is.
  void solve(const Vec3Field& residual, Vec3Field& correction);

  std::size_t memory() const;  ///< bytes held

 private:
  static constexpr int fewest = 5;  ///< rows or columns that are not halved

  struct Level {
    BlockLevel loops;
    NaturalBlocks natural;
    AlignedFloats natural_numbers, blocks, vectors;
    std::vector<BlockCoupling> couplings[BlockLevel::kinds];    ///< of each kind of group
    LineInterpolation row_interpolation, column_interpolation;  ///< from the next coarser one
  };

  void add_blocks(int coupling, std::size_t first, std::size_t count, double scale,
                  const std::array<const double*, 6>& blocks);
  void add_identity(int coupling, std::size_t first, std::size_t count, double value);
  std::optional<int> find_coupling(std::size_t& first, int offset) const;
  template <class Visit>
  void for_each_place(std::size_t first, std::size_t count, Visit visit) const;
  std::size_t place_of(std::size_t particle) const;
  void add_levels();
  void add_level(int rows, int columns, int reach);
  void set_couplings(Level& level);
  void arrange(Level& level);
  bool invert_coarsest();
  void cycle(std::size_t number);
  void solve_coarsest();

  int rows_ = 0, columns_ = 0;  ///< as given; the finest level has them exchanged where the grid is turned
  bool is_turned_ = false;
  Interpolation interpolation_ = Interpolation::linear;
  const BlockCycleKernels* kernels_ = nullptr;
  std::vector<Level> levels_;
  std::vector<double> coarsest_;  ///< its inverse, row by row
  AlignedFloats coarsening_scratch_, transfer_scratch_;
};

}  // namespace cloth
