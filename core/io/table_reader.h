// A table of numbers that somebody wrote, as columns; what is wrong with it by file, line and column.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/csv.h"
#include "params/problem.h"

namespace cloth {

/// Takes a table apart, and notes what is wrong with it.
class TableReader {
 public:
  TableReader(const CsvTable& table, std::string place, std::vector<Problem>& problems)
      : table_(table), place_(std::move(place)), problems_(problems) {}

  /// False, with a problem, where there is no row, or one of another length than the names.
  bool is_whole() {
    if (table_.rows.empty()) add("", "", "must have a line of column names and a line of numbers at least");
    for (std::size_t row = 0; row < table_.rows.size() && problems_.empty(); ++row)
      if (const std::size_t count = table_.rows[row].size(); count != table_.header.size())
        add("", "", fmt::format("has {} fields, and the first line {}", count, table_.header.size()), row);
    return problems_.empty();
  }

  bool has(const std::string& column) const { return index_of(column) < table_.header.size(); }

  /// All numbers of a column; a problem for the first that is none.
  std::vector<double> column(const std::string& name) {
    std::vector<double> numbers;
    const std::size_t at = index_of(name);
    for (std::size_t row = 0; row < table_.rows.size(); ++row) {
      const auto& fields = table_.rows[row];
      const std::string text = at < fields.size() ? fields[at] : "";
      double value = 0;
      const char* end = text.data() + text.size();
      const auto [last, error] = std::from_chars(text.data(), end, value);
      if (error != std::errc() || last != end || text.empty() || !std::isfinite(value)) {
        add(name, '"' + text + '"', "must be a number", row);
        return {};
      }
      numbers.push_back(value);
    }
    return numbers;
  }

  /// About a row, from 0, or about the file.
  void add(const std::string& column, const std::string& value, const std::string& rule,
           std::optional<std::size_t> row = {}) {
    Problem problem{column, value, rule, place_};
    if (row) problem.line = static_cast<int>(*row) + 2;
    if (row) problem.column = column.empty() ? 1 : static_cast<int>(index_of(column)) + 1;
    problems_.push_back(std::move(problem));
  }

 private:
  std::size_t index_of(const std::string& column) const {
    return static_cast<std::size_t>(std::find(table_.header.begin(), table_.header.end(), column) -
                                    table_.header.begin());
  }

  const CsvTable& table_;
  std::string place_;
  std::vector<Problem>& problems_;
};

}  // namespace cloth
