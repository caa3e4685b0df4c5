// Approximate solutions of A x = b on a grid by one V-cycle of multigrid, for three right-hand sides at once
// and in single precision: a correction within an iteration that computes its residual in double.
//
// Two steps of Jacobi's method before and after the correction of the coarser grid, with the steps of
// Chebyshev's polynomial over the upper three quarters of the spectrum of D^-1 A (Adams, Brezina, Hu and
// Tuminaro 2003); every second row and column with bilinear interpolation; Galerkin's matrices; the inverse
// itself where no direction has more than five particles (Trottenberg, Oosterlee and Schueller 2001). The
// cycle is symmetric, so that it is a preconditioner as well. Last, the field that is constant over all free
// particles is corrected in double: what it contributes to the sum of b is met to rounding.
//
//     GridMultigrid multigrid;
//     multigrid.prepare(std::move(stencils));        // GridStencils
//     if (multigrid.convergence_factor() <= 0.5) multigrid.solve(b, x);
#pragma once

#include <optional>

#include "geometry/vec3_field.h"
#include "sparse/cycle_kernels.h"
#include "sparse/grid_stencils.h"

namespace cloth {

class GridMultigrid {
 public:
  /// False where a diagonal or the coarsest matrix is not positive; nothing can then be solved.
  bool prepare(GridStencils matrix);

  /// By which a cycle multiplies the error at last, at most, of three random fields: over eight cycles after
  /// four. The same for the same matrix.
  double convergence_factor();

  /// x = one cycle from zero for A x = b. Both have one vector per particle, x zero where fixed.
  void solve(const Vec3Field& b, Vec3Field& x);

  std::size_t memory() const;  ///< bytes held

 private:
  static constexpr int fewest = 5;     ///< particles in a direction that is not halved
  static constexpr int smoothing = 2;  ///< steps before, and after

  struct Level {
    Level(const GridStencils& matrix);
    Level(const Level&) = delete;
    Level(Level&&) = default;

    CycleGrid grid;
    AlignedFloats storage;  ///< of all that follows
    float *diagonal, *inverse, *free;
    CycleMatrix matrix;
    CycleField x, b, r;
    std::array<float, smoothing> scale;
  };

  void cycle(std::size_t level);
  void smooth(Level& level, int step);
  void solve_coarsest();
  bool invert_coarsest(const GridStencils& matrix);
  void correct_constant(const Vec3Field& b, Vec3Field& x) const;

  const CycleKernels* kernels_ = nullptr;
  std::vector<Level> levels_;
  std::vector<double> coarsest_;         ///< its inverse, row by row
  std::vector<double> free_, row_sums_;  ///< 1 where free; the sums of A's rows
  double sum_ = 0;                       ///< of all of A
  AlignedFloats row_;                    ///< scratch
};

}  // namespace cloth
