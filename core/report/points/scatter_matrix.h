// Panels of points, one for each pair of columns: all columns against each other, or outputs against
// parameters with the mean of the output along the parameter (its main effect).
#pragma once

#include <string>
#include <vector>

#include "report/points/point_table.h"
#include "report/svg.h"

namespace cloth {

struct ScatterMatrix {
  std::string title{}, subtitle{};
  std::vector<std::string> caption{};
  PointTable table{};
  /// Main effects: a column of panels for each parameter and a row for each output. Otherwise a row and a
  /// column for each column of the table: points below the diagonal, on it how often values occur, above it
  /// rank correlations.
  bool main_effects = false;
  double width = 960;  ///< [px]
};

/// Further rows are left out of the points (not of means and correlations), evenly.
inline constexpr std::size_t most_scatter_points = 800;

/// The mean of y where x is in each of at most so many intervals of equal numbers of rows, from low x to high
/// x; where x has no more values than that, at each of them. Rows without both values are left out.
std::vector<SvgPoint> mean_along(const std::vector<double>& x, const std::vector<double>& y,
                                 std::size_t intervals);

double height_of(const ScatterMatrix& plot);
void draw(PlotCanvas& canvas, const ScatterMatrix& plot);

}  // namespace cloth
