// The points of a study of several parameters: a column for each parameter and each output, a row for each
// run. What plots of them are made from.
#pragma once

#include <string>
#include <vector>

#include "report/axis.h"

namespace cloth {

struct PointColumn {
  Axis axis{};  ///< label, unit and scale
  bool is_output = false;
  std::vector<double> values{};  ///< one for each row; of an output not a number where the run failed
};

struct PointTable {
  std::vector<PointColumn> columns{};  ///< parameters first
  std::vector<std::string> notes{};    ///< one for each row, for tooltips; empty: "run 1", "run 2", ...
  std::vector<int> tags{};             ///< one for each row, of its SvgTip; empty: none

  std::size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
  /// Whether an output of the row has no value.
  bool failed(std::size_t row) const;
  std::size_t failures() const;
  /// Indices of the columns that are outputs, or that are not.
  std::vector<std::size_t> columns_that(bool are_outputs) const;
  /// The row in words: its note, then a line for each column.
  std::string text_of(std::size_t row) const;
  int tag_of(std::size_t row) const { return row < tags.size() ? tags[row] : -1; }
  /// At most so many rows, evenly spread.
  std::vector<std::size_t> some_rows(std::size_t most) const;
};

/// The map of a column's values to places [px].
AxisMap map_of(const PointColumn& column, double from, double to);

/// "label (unit)" in lines no wider than this [px].
std::vector<std::string> column_title(const PointColumn& column, double width);

/// Spearman's rank correlation (1904) over rows in which both are numbers; not a number where there are fewer
/// than three of them or one does not vary.
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace cloth
