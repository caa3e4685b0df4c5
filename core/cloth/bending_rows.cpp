#include "cloth/bending_rows.h"

#include <map>

namespace cloth {

BendingRows bending_rows(const BendingRuns& runs, std::size_t particles) {
  std::vector<std::map<std::size_t, double>> entries(particles);
  for_each_bending_pair(runs, [&](std::size_t i, std::size_t j, double stiffness) {
    entries[i][j] -= stiffness;
    entries[j][i] -= stiffness;
  });
  BendingRows rows;
  rows.begin.push_back(0);
  for (const auto& row : entries) {
    for (const auto& [j, stiffness] : row) {
      rows.column.push_back(static_cast<std::int32_t>(j));
      rows.stiffness.push_back(stiffness);
    }
    rows.begin.push_back(static_cast<std::uint32_t>(rows.column.size()));
  }
  return rows;
}

}  // namespace cloth
