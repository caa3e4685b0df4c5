// A table for a terminal, its columns aligned, or the same as Markdown.
#pragma once

#include <string>
#include <vector>

namespace cloth {

struct TextColumn {
  std::string header;     ///< in sentence case, with the unit
  bool is_right = false;  ///< numbers stand at the right
};

struct TextTable {
  std::vector<TextColumn> columns;
  std::vector<std::vector<std::string>> rows;  ///< missing cells are empty
};

/// Two spaces between columns, none at the end of a line. Columns that are empty in every row are left out.
std::string to_text(const TextTable& table);
std::string to_markdown(const TextTable& table);

}  // namespace cloth
