// Multigrid by smoothed aggregation (Vanek, Mandel and Brezina 1996) for symmetric, positive definite
// matrices of 3x3 blocks with any pattern, as the Jacobians of implicit steps on meshes: a cycle as
// preconditioner of conjugate gradients.
//
// Neighbours in a graph of strong couplings become one point of a coarser level, with six unknowns: how much
// of each rigid motion of its aggregate. That is made smoother by a step of Jacobi's method along the strong
// couplings, and the coarser matrices are Galerkin's, P^T A P. A cycle has one sweep of Gauss-Seidel before
// and one after, in single precision; the coarsest level has a dense inverse.
//
//     AggregationMultigrid multigrid;
//     multigrid.analyse(size, couplings, strong);             // once for a pattern
//     if (multigrid.prepare(diagonal, coupling_blocks, positions))
//       multigrid.solve(residual, correction);                // one cycle
#pragma once

#include "geometry/vec3_field.h"
#include "sparse/aggregates.h"
#include "sparse/aggregation_kernels.h"

namespace cloth {

class AggregationMultigrid {
 public:
  /// `couplings`: pairs of unknowns, of 0..size, that have a block. `strong`: those of them that unite
  /// neighbours. Both may repeat.
  void analyse(int size, const std::vector<Coupling>& couplings, const std::vector<Coupling>& strong);

  /// As BlockCholesky::factorise() has them, nine numbers each. `positions`, m: of each unknown, for the
  /// rigid motions; three numbers each. False where the matrix is seen not to be positive definite or finite;
  /// nothing can then be solved.
  bool prepare(std::span<const double> diagonal, std::span<const double> coupling_blocks,
               std::span<const double> positions);

  /// One cycle from zero: correction, about A^-1 residual; three numbers for each unknown.
  void solve(std::span<const double> residual, std::span<double> correction);

 private:
  struct Level {
    std::size_t block = 3;  ///< rows
    SparsePattern pattern;
    std::vector<int> diagonal, mirrored;
    int reach = 0;          ///< the furthest column from its row
    Aggregates aggregates;  ///< the points of the next level; none on the coarsest
    SparsePattern prolongator, image;
    std::vector<int> place;
    std::vector<float> blocks, inverse, x, b, r, p, row, basis, sums;
    std::vector<double> modes, tentative;
    AggregationLevel loops();
    AggregationTransfer transfer(Level& coarse);
    int rows() const { return pattern.rows(); }
    std::size_t width() const { return block == 3 ? 4 : 8; }  ///< numbers of a point in x, b and r
  };

  static void set_pattern(Level& level, SparsePattern pattern, std::size_t block);
  static void set_transfer(Level& level, const SparsePattern& graph, const SparsePattern& reach);
  static bool invert_diagonal(Level& level);
  static void set_modes(Level& level, std::span<const double> positions);
  void coarsen(Level& fine, Level& coarse);
  bool invert_coarsest();
  void solve_coarsest();
  void cycle(std::size_t number);
  static const AggregationKernels::Loops& kernels(const Level& level);

  std::vector<Level> levels_;
  std::vector<std::size_t> upper_, lower_;  ///< of each coupling, entries of the finest pattern
  std::vector<double> coarsest_;            ///< the inverse; empty: sweeps stand for it
};

}  // namespace cloth
