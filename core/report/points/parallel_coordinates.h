// Parallel coordinates (Inselberg 1985): an axis for each column, a line for each run, coloured by one of the
// outputs. Runs that failed are dashed and end at the last parameter. Brushes on the axes pick runs.
#pragma once

#include <string>
#include <vector>

#include "report/points/point_table.h"
#include "report/svg.h"

namespace cloth {

/// Picks the runs whose value of a column lies from `low` to `high`.
struct AxisBrush {
  std::size_t column = 0;
  double low = 0, high = 0;
};

struct ParallelCoordinates {
  std::string title{}, subtitle{};
  std::vector<std::string> caption{};
  PointTable table{};
  std::size_t coloured_by = 0;            ///< a column
  std::vector<AxisBrush> brushes{};       ///< one for a column at most; runs outside of any are faint
  std::string invitation{};               ///< said in place of the count of runs while there is no brush
  double width = 960, plot_height = 380;  ///< [px]
};

/// Further rows are left out, evenly, and the caption says so.
inline constexpr std::size_t most_parallel_rows = 2000;

/// Whether a row lies within every brush; one without a value of a brushed column does not.
bool is_kept(const ParallelCoordinates& plot, std::size_t row);
/// "12 of 64 runs"
std::string kept_words(const ParallelCoordinates& plot);

/// Where the axis of a column is drawn [px], with the map of its values to places along it.
struct ParallelAxis {
  double x = 0, top = 0, bottom = 0;
  AxisMap map;
};
std::vector<ParallelAxis> axes_of(const ParallelCoordinates& plot);
inline constexpr double parallel_bar_width = 14;  ///< of the bar behind each axis [px]

double height_of(const ParallelCoordinates& plot);
void draw(PlotCanvas& canvas, const ParallelCoordinates& plot);

/// The same drawing with a short script in it: in a browser the pointer draws a range on an axis, and runs
/// outside of any range fade. A click on a range takes it away. It needs nothing from outside; what shows no
/// scripts shows the drawing.
std::string to_brushed_svg(const ParallelCoordinates& plot);

}  // namespace cloth
