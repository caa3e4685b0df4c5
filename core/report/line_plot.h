// Plots of points and lines as SVG: error against run time, energy against time.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/axis.h"
#include "report/svg.h"

namespace cloth {

using PlotRange = std::optional<std::pair<double, double>>;

/// What an axis cannot show (not finite; zero or negative where logarithmic) is left out, and the caption
/// says so.
struct PlotPoint {
  double x = 0, y = 0;
  PlotRange x_range{}, y_range{};  // error bars from .first to .second
  std::string note{};              // lines of the tooltip after name, x and y
  int tag = -1;                    // of its SvgTip
};

/// A run without a result: drawn in the row of failures above the plot, at x if that can be shown, else at
/// the left end.
struct FailedPoint {
  double x = 0;
  std::string cause{};
  int tag = -1;  // of its SvgTip
};

struct PlotSeries {
  std::string name{};
  std::string detail{};  // second line of the legend, such as "order 4, observed 3.98"
  std::vector<PlotPoint> points{};
  std::vector<FailedPoint> failed{};
  std::optional<int> style{};  // of style_of_series; none: its place among the series
  bool line = true, markers = true;
};

/// Everything below y is grey.
struct PlotFloor {
  double y = 0;
  std::string label{};
};

struct ReferenceLine {
  enum class Direction { horizontal, vertical } direction = Direction::horizontal;
  double at = 0;
  std::string label{};
};

/// y ~ x^slope, drawn on log-log axes only. A method of order p has slope p against the step, -p against the
/// run time.
struct SlopeTriangle {
  double slope = 1;
  std::string label{};
};

struct LinePlot {
  std::string title{}, subtitle{};
  std::vector<std::string> caption{};  // paragraphs under the plot, wrapped
  Axis x{}, y{};
  std::vector<PlotSeries> series{};
  std::optional<PlotFloor> floor{};
  std::vector<SlopeTriangle> triangles{};
  std::vector<ReferenceLine> lines{};
  std::string
      best_line{};  // its name in the legend; empty: none. The lowest y that any run reached with at most x
  double width = 960;        // of the whole picture [px]
  double plot_height = 440;  // of the axes' frame [px]
};

/// The height of the whole picture [px]: titles, legend and caption take what they need.
double height_of(const LinePlot& plot);
void draw(PlotCanvas& canvas, const LinePlot& plot);

}  // namespace cloth
