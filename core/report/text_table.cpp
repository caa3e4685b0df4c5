#include "report/text_table.h"

#include <algorithm>

namespace cloth {
namespace {

/// Characters, not bytes, of UTF-8 text.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string cell_of(const std::vector<std::string>& row, std::size_t column) {
  return column < row.size() ? row[column] : "";
}

bool is_used(const TextTable& table, std::size_t column) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [&](const auto& row) { return !cell_of(row, column).empty(); });
}

std::string padded(const std::string& text, std::size_t width, bool is_right) {
  const std::string space(width - std::min(width, width_of(text)), ' ');
  return is_right ? space + text : text + space;
}

}  // namespace

std::string to_text(const TextTable& table) {
  std::vector<std::string> lines(table.rows.size() + 1);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (!is_used(table, c)) continue;
    const TextColumn& column = table.columns[c];
    std::size_t width = width_of(column.header);
    for (const auto& row : table.rows) width = std::max(width, width_of(cell_of(row, c)));
    for (std::size_t line = 0; line < lines.size(); ++line) {
      const std::string& text = line == 0 ? column.header : cell_of(table.rows[line - 1], c);
      lines[line] += (lines[line].empty() ? "" : "  ") + padded(text, width, column.is_right);
    }
  }
  std::string text;
  for (std::string& line : lines) {
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

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
