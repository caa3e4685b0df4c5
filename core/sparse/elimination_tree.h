// What Cholesky factors of a pattern look like, before any number is known.
//
// Column j of L has entries where the matrix has them and where the columns have them that j is the parent
// of; parent(j) is its first entry below the diagonal (Liu 1990). Neighbouring columns of the same structure
// make a front: a dense lower trapezoid of `width` columns, `height` rows, the first `width` of which are the
// columns' own.
#pragma once

#include <vector>

#include "sparse/elimination_order.h"

namespace cloth {

struct Front {
  int first = 0;          ///< column, in the order of elimination
  int width = 0;          ///< columns
  int parent = -1;        ///< front that its update goes to; -1: none
  std::vector<int> rows;  ///< below its own columns, ascending, in the order of elimination
  int height() const { return width + static_cast<int>(rows.size()); }
};

struct EliminationTree {
  std::vector<int> place;     ///< of each unknown in the order of elimination
  std::vector<Front> fronts;  ///< children before parents; each right behind its subtree
};

/// `order`: a permutation of the unknowns; it is changed where that brings the columns of a subtree together,
/// which leaves the fill as it is. Fronts are merged where that costs few zeros.
EliminationTree analyse(const std::vector<Coupling>& couplings, const std::vector<int>& order);

}  // namespace cloth
