// Which entries of a sparse matrix are stored: row by row, columns ascending. An entry may be a block.
#pragma once

#include <span>
#include <vector>

#include "sparse/elimination_order.h"

namespace cloth {

struct SparsePattern {
  std::vector<int> begin{0};  ///< of each row in `column`, and the end of the last
  std::vector<int> column;    ///< of each entry

  int rows() const { return static_cast<int>(begin.size()) - 1; }
  std::size_t entries() const { return column.size(); }
  std::span<const int> row(int i) const {
    const auto r = static_cast<std::size_t>(i);
    return std::span(column).subspan(static_cast<std::size_t>(begin[r]),
                                     static_cast<std::size_t>(begin[r + 1] - begin[r]));
  }
  std::size_t longest_row() const;  ///< entries
  /// The number of the entry in row i and column j, which must be stored.
  std::size_t entry(int i, int j) const;
  /// Adds a row, in any order and with repetitions, which `columns` loses.
  void add_row(std::vector<int>& columns);
};

/// The diagonal, and both entries of every coupling. Couplings may repeat.
SparsePattern symmetric_pattern(int rows, const std::vector<Coupling>& couplings);
SparsePattern transposed(const SparsePattern& pattern, int columns);
/// Of the product of two matrices.
SparsePattern product(const SparsePattern& left, const SparsePattern& right);

}  // namespace cloth
