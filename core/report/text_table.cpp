#include "report/text_table.h"

#include <algorithm>

namespace cloth {
namespace {

std::string cell_of(const std::vector<std::string>& row, std::size_t column) {
  return column < row.size() ? row[column] : "";
}

bool is_used(const TextTable& table, std::size_t column) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [&](const auto& row) { return !cell_of(row, column).empty(); });
}

}  // namespace

std::string to_markdown(const TextTable& table) {
  std::string head = "|", rule = "|";
  std::vector<std::size_t> used;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (!is_used(table, c)) continue;
    used.push_back(c);
    head += " " + table.columns[c].header + " |";
    rule += table.columns[c].is_right ? "--:|" : "---|";
  }
  std::string text = head + "\n" + rule + "\n";
  for (const auto& row : table.rows) {
    text += "|";
    for (const std::size_t c : used) text += " " + cell_of(row, c) + " |";
    text += "\n";
  }
  return text;
}

}  // namespace cloth
