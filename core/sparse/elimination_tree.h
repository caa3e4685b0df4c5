// Symbolic factorisation: the structure of the Cholesky factors of a pattern.
//
// Column j of L has entries where the matrix has them and where the columns whose parent is j have them;
// parent(j) is the row of the first entry of column j below the diagonal (Liu 1990). Neighbouring columns of
// the same structure form a front: a dense lower trapezoid of `width` columns and `height` rows, the first
// `width` of which are the columns' own.
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

/// `order`: a permutation of the unknowns. It is changed so that the columns of a subtree are contiguous,
/// which does not change the fill. Fronts are merged where that adds few zeros.
EliminationTree analyse(const std::vector<Coupling>& couplings, const std::vector<int>& order);

}  // namespace cloth
