// The preconditioner of the conjugate gradients of a grid's tensions: along every line of springs the
// tridiagonal part of J W J^T, solved exactly (Thomas' algorithm). Columns and diagonals are solved row by
// row, rows of the grid in lanes, several side by side.
#pragma once

#include "limiter/grid_equations.h"

namespace cloth {

/// The first of the rows that are solved side by side with `row`.
inline int first_of_lanes(int row) {
  return row / lanes_of_rows * lanes_of_rows;
}

class LinePreconditioner {
 public:
  /// Both must outlive this.
  LinePreconditioner(GridEquations& equations, const TensionKernels& kernels);

  /// The weights of the equations have changed.
  void take_weights();

  /// Factors of the active rows; `ridge` is the share of the diagonal that is added to it.
  void factorise(double ridge);

  /// Forward elimination of a row of `residual` into `solved`, after the rows above it.
  void eliminate(std::size_t family, int row);

  /// Back substitution from the last row to the first. Returns residual . solved.
  double substitute();

 private:
  struct Factors {
    AlignedFloats link, pivot;  ///< of rows in lanes
  };

  FactorRow row_at(std::size_t family, std::ptrdiff_t i);
  void factorise_columns(std::size_t family, double ridge);
  void factorise_rows(std::size_t family, double ridge);
  void solve_rows(std::size_t family, int first_row);

  GridEquations& equations_;
  const TensionKernels& kernels_;
  std::vector<Factors> factors_;       ///< of each family
  AlignedFloats zero_;                 ///< a row
  AlignedFloats weight_;               ///< of all rows in lanes, block after block
  AlignedFloats x_, y_, z_, scratch_;  ///< rows in lanes
};

}  // namespace cloth
