// Maps of classes over names, such as methods over cases.
#pragma once

#include <string>
#include <vector>

#include "report/palette.h"
#include "report/svg.h"

namespace cloth {

struct CategoryCell {
  int class_index = -1;  // of CategoryMap::classes; outside of them: not computed, drawn empty
  std::string note{};    // tooltip after row, column and the class
  int tag = -1;          // of its SvgTip
};

struct CategoryMap {
  std::string title{}, subtitle{};
  std::vector<std::string> columns{}, rows{};
  std::vector<CategoryCell> cells{};  // row after row
  std::vector<ClassStyle> classes{};
  double width = 960;  // of the whole picture [px]
};

/// The height of the whole picture [px].
double height_of(const CategoryMap& map);
void draw(PlotCanvas& canvas, const CategoryMap& map);

}  // namespace cloth
