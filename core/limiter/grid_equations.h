// The equations for the tensions of a grid: what GridRounds and its preconditioner share.
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

}  // namespace cloth
