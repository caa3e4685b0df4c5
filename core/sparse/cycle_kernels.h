// The loops of a multigrid cycle (sparse/grid_multigrid.h) over the rows of a grid, in single precision and
// for three right-hand sides at once. The numbers of a row lie beside one another; around the grid lie zeros
// (CycleGrid::margin), so that no loop asks whether a neighbour exists.
#pragma once

#include <cstddef>

#include "kernels/kernel_table.h"

namespace cloth {

struct CycleGrid {
  /// Rows, and numbers of a row, that a loop reads outside the grid on each side, at most. Loops write up to
  /// the register's width beyond a row's end, where masks are zero.
  static constexpr int margin = 2, lanes = 16;
  int rows = 0, columns = 0;
  std::ptrdiff_t stride = 0;  ///< from a row to the next, in numbers
};

/// Where row 0 begins, for each right-hand side.
struct CycleField {
  float* of[3] = {};
};

/// The symmetric matrix of a level. Fixed particles have a zero wherever it is multiplied.
struct CycleMatrix {
  static constexpr int most_neighbours = 24;  ///< all that lie within two rows and columns
  const float* diagonal = nullptr;
  int count = 0;  ///< of neighbours, or, where they are uniform, of pairs of opposite ones
  std::ptrdiff_t offset[most_neighbours] = {};
  bool uniform = false;
  float weight[most_neighbours] = {};          ///< of the neighbours, where uniform
  const float* weights[most_neighbours] = {};  ///< of each particle, otherwise
};

struct CycleKernels {
  /// out = scale inverse b
  void (*begin)(const CycleGrid& grid, const float* inverse, float scale, CycleField b, CycleField out);
  /// out = x + scale inverse (b - A x)
  void (*relax)(const CycleGrid& grid, const CycleMatrix& a, const float* inverse, float scale, CycleField b,
                CycleField x, CycleField out);
  /// out = free (b - A x)
  void (*residual)(const CycleGrid& grid, const CycleMatrix& a, const float* free, CycleField b, CycleField x,
                   CycleField out);
  /// b = free P^T r, P bilinear interpolation to `fine` from every second row and column of it, or from every
  /// one where `coarse` has as many. `row`: room for a row of `fine` with its margins.
  void (*restrict_to)(const CycleGrid& fine, const CycleGrid& coarse, const float* free, CycleField r,
                      CycleField b, float* row);
  /// x += free P y
  void (*prolong)(const CycleGrid& fine, const CycleGrid& coarse, const float* free, CycleField y,
                  CycleField x, float* row);

  CLOTHLAB_KERNEL_TABLE(CycleKernels)
};

}  // namespace cloth
