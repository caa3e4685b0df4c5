// The second derivative K of the bending energy (cloth/bending.h) by its rows: a product with it costs a
// third of that over the elements where these do not lie in runs, as on a mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/bending.h"

namespace cloth {

/// Row i holds K_ij, N/m, of each j but i, whose own is minus their sum: no product comes from moving all
/// alike.
struct BendingRows {
  std::vector<std::uint32_t> begin;  ///< of each row and behind the last; empty: there are no rows
  std::vector<std::int32_t> column;  ///< j, ascending
  std::vector<double> stiffness;     ///< K_ij
};

BendingRows bending_rows(const BendingRuns& runs, std::size_t particles);

/// visit(i, j, -K_ij) for every pair of particles: by the rows, each once, or where there are none by the
/// runs.
template <class Visit>
void for_each_bending_pair(const BendingRows& rows, const BendingRuns& runs, Visit visit) {
  if (rows.begin.empty()) return for_each_bending_pair(runs, visit);
  for (std::size_t i = 0; i + 1 < rows.begin.size(); ++i)
    for (std::size_t k = rows.begin[i]; k < rows.begin[i + 1]; ++k) {
      const auto j = static_cast<std::size_t>(rows.column[k]);
      if (j > i) visit(i, j, -rows.stiffness[k]);
    }
}

}  // namespace cloth
