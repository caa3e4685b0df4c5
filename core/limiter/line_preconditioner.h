// The equations for the tensions of a grid, and the preconditioner of their conjugate gradients: along every
// line of springs the tridiagonal part of J W J^T, solved exactly (Thomas' algorithm). Columns and diagonals
// are solved row by row, rows of the grid in lanes, several side by side.
#pragma once

#include <algorithm>
#include <vector>

#include "geometry/aligned.h"
#include "limiter/grid_plan.h"
#include "limiter/tension_kernels.h"

namespace cloth {

/// Rows of a grid, from `begin` up to `end`.
struct RowInterval {
  int begin = 0, end = 0;
  bool is_empty() const { return begin >= end; }
};

/// A family's springs, each at the place of the particle that it begins at.
struct FamilyEquations {
  GridFamily plan;
  std::ptrdiff_t offset = 0;       ///< from a spring's first particle to its second
  AlignedDoubles tension;          ///< m: times h^2 and the largest inverse mass
  AlignedFloats ax, ay, az, over;  ///< equations, see SpringRows
  AlignedFloats change, residual, solved, direction, product;  ///< of conjugate gradients
  std::vector<RowLengths> lengths;                             ///< of each row
  std::vector<RowResidual> residuals;                          ///< of each row, of soft springs
  std::vector<std::uint8_t> pins;                              ///< rows with springs between two pins

  bool is_row() const { return plan.down == 0; }
  RowInterval rows_within(RowInterval rows) const {
    return {std::max(rows.begin, 0), std::min(rows.end, plan.rows)};
  }
};

struct GridEquations {
  GridPlan plan;
  std::vector<FamilyEquations> families;
  AlignedFloats weight;  ///< inverse masses over the largest one
  RowInterval active;    ///< rows in which springs begin that are over their limit or have a tension
};

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
