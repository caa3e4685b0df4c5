// A table as Markdown.
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

/// Columns that are empty in every row are left out.
std::string to_markdown(const TextTable& table);

}  // namespace cloth
