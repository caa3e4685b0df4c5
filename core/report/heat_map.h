// Maps of classes over two parameters as SVG, one panel for each method.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "report/axis.h"
#include "report/palette.h"
#include "report/svg.h"

namespace cloth {

struct HeatCell {
  int class_index = 0;  // of HeatMap::classes; outside of them: not computed, drawn empty
  std::string note{};   // tooltip after x, y and the class
  int tag = -1;         // of its SvgTip
};

/// A line over the cells, in the axes' units. Where it leaves the panel or cannot be shown it is broken.
/// Curves with the same label share one entry in the legend, so give them the same style.
struct OverlayCurve {
  std::string label{};
  Dash dash = Dash::solid;
  PageColour colour = page_colours().ink;
  std::vector<std::pair<double, double>> points{};
};

struct HeatPanel {
  std::string title{};
  /// Row after row of x, beginning with the lowest y: index = iy * x_values.size() + ix
  std::vector<HeatCell> cells{};
  std::vector<OverlayCurve> curves{};
};

struct HeatMap {
  std::string title{}, subtitle{};
  std::vector<std::string> caption{};          // paragraphs under the panels, wrapped
  Axis x{}, y{};                               // their limits are not used: the cells decide
  std::vector<double> x_values{}, y_values{};  // the cells' middles, ascending; positive where logarithmic
  std::vector<ClassStyle> classes = run_classes();
  std::vector<HeatPanel> panels{};
  int columns = 3;       // panels beside each other; further ones go below
  double width = 960;    // of the whole picture [px]
  double highest = 420;  // of a panel; otherwise as high as wide [px]
};

/// The mark of a class in the middle of a cell or a legend's swatch.
void draw_cell_mark(PlotCanvas& canvas, const ClassStyle& style, SvgPoint centre, double radius);

/// The height of the whole picture [px].
double height_of(const HeatMap& map);
void draw(PlotCanvas& canvas, const HeatMap& map);

}  // namespace cloth
