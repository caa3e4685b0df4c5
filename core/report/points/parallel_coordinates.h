// Parallel coordinates (Inselberg 1985): an axis for each column, a line for each run, coloured by one of the
// outputs. Runs that failed are dashed and end at the last parameter.
#pragma once

#include <string>
#include <vector>

#include "report/points/point_table.h"
#include "report/svg.h"

namespace cloth {

struct ParallelCoordinates {
  std::string title{}, subtitle{};
  std::vector<std::string> caption{};
  PointTable table{};
  std::size_t coloured_by = 0;            ///< a column
  double width = 960, plot_height = 380;  ///< [px]
};

/// Further rows are left out, evenly, and the caption says so.
inline constexpr std::size_t most_parallel_rows = 2000;

double height_of(const ParallelCoordinates& plot);
void draw(PlotCanvas& canvas, const ParallelCoordinates& plot);

/// The same drawing with a short script in it: in a browser the pointer draws a range on an axis, and runs
/// outside of any range fade. A click on a range takes it away. It needs nothing from outside; what shows no
/// scripts shows the drawing.
std::string to_brushed_svg(const ParallelCoordinates& plot);

}  // namespace cloth
