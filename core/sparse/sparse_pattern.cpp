#include "sparse/sparse_pattern.h"

#include <algorithm>

#include "geometry/at.h"

namespace cloth {

std::size_t SparsePattern::longest_row() const {
  std::size_t longest = 0;
  for (int i = 0; i < rows(); ++i) longest = std::max(longest, row(i).size());
  return longest;
}

std::size_t SparsePattern::entry(int i, int j) const {
  const std::span<const int> columns = row(i);
  return at(begin[at(i)]) +
         at(static_cast<int>(std::lower_bound(columns.begin(), columns.end(), j) - columns.begin()));
}

void SparsePattern::add_row(std::vector<int>& columns) {
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  column.insert(column.end(), columns.begin(), columns.end());
  begin.push_back(static_cast<int>(column.size()));
}

SparsePattern symmetric_pattern(int rows, const std::vector<Coupling>& couplings) {
  std::vector<std::vector<int>> columns(at(rows));
  for (int i = 0; i < rows; ++i) columns[at(i)].push_back(i);
  for (const auto& [i, j] : couplings) {
    columns[at(i)].push_back(j);
    columns[at(j)].push_back(i);
  }
  SparsePattern pattern;
  for (std::vector<int>& of_row : columns) pattern.add_row(of_row);
  return pattern;
}

SparsePattern transposed(const SparsePattern& pattern, int columns) {
  SparsePattern result;
  result.begin.assign(at(columns) + 1, 0);
  for (const int j : pattern.column) ++result.begin[at(j) + 1];
  for (std::size_t j = 0; j < at(columns); ++j) result.begin[j + 1] += result.begin[j];
  result.column.resize(pattern.entries());
  std::vector<int> next(result.begin.begin(), result.begin.end() - 1);
  for (int i = 0; i < pattern.rows(); ++i)
    for (const int j : pattern.row(i)) result.column[at(next[at(j)]++)] = i;
  return result;
}

SparsePattern product(const SparsePattern& left, const SparsePattern& right) {
  SparsePattern result;
  std::vector<int> columns;
  for (int i = 0; i < left.rows(); ++i) {
    columns.clear();
    for (const int j : left.row(i)) {
      const std::span<const int> more = right.row(j);
      columns.insert(columns.end(), more.begin(), more.end());
    }
    result.add_row(columns);
  }
  return result;
}

}  // namespace cloth
