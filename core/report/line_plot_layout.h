// Where everything in a line plot goes, before the first line is drawn.
#pragma once

#include <string>
#include <vector>

#include "report/line_plot.h"
#include "report/plot_parts.h"

namespace cloth {

constexpr double failure_row = 13;                           // height of a row of failed runs [px]
constexpr double legend_swatch_width = 42, legend_gap = 22;  // [px]

/// A failed run and its place.
struct FailureMark {
  std::size_t series = 0;
  const FailedPoint* point = nullptr;
  double x = 0;  // [px]
  int row = 0;   // counted upwards from the frame
};

struct LegendEntry {
  enum class Kind { series, best, failed } kind = Kind::series;
  std::size_t series = 0;                     // of Kind::series
  std::vector<std::string> name{}, detail{};  // lines
  double height() const { return 17.0 * double(name.size()) + 14.5 * double(detail.size()) + 8; }
};

struct LineLayout {
  /// The plot must outlive its layout.
  explicit LineLayout(const LinePlot& line_plot);

  const LinePlot& plot;
  AxisMap x, y;
  Box frame;
  double lane_top = 0;  // of the failed runs; the frame's top where none failed
  double legend_left = 0, height = 0;
  std::vector<LegendEntry> legend;
  std::vector<FailureMark> failures;
  std::vector<std::string> caption;  // the plot's, and how many points are left out

  bool shows(const PlotPoint& point) const {
    return can_show(plot.x.scale, point.x) && can_show(plot.y.scale, point.y);
  }
  bool has_floor() const { return plot.floor && can_show(plot.y.scale, plot.floor->y); }
  /// No point that the axes can show.
  bool is_empty() const;
  SeriesStyle style_of(std::size_t series) const;

  /// A value that can be shown, moved to the edge where it lies outside.
  double place_x(double value) const;
  double place_y(double value) const;

  /// Runs of neighbouring points that can be shown.
  std::vector<std::vector<SvgPoint>> strokes(const PlotSeries& series) const;
  /// Boxes that cover lines and markers.
  std::vector<Box> data_boxes() const;
  /// These, the floor and the reference lines with their labels.
  std::vector<Box> occupied() const;

 private:
  void collect_legend();
  void collect_caption();
  void lay_out();
  void place_failures();
};

/// Where a slope triangle goes: off the data where there is room.
struct PlacedTriangle {
  SvgPoint corner;     // the right angle
  SvgPoint along, up;  // the ends of its horizontal and vertical leg
  SvgPoint label;      // baseline of the label, left aligned
  std::string text;
};

/// `occupied`: boxes to keep off. A triangle with no free place goes where it covers least.
std::vector<PlacedTriangle> place_triangles(const std::vector<SlopeTriangle>& triangles, const AxisMap& x,
                                            const AxisMap& y, const Box& frame, std::vector<Box> occupied);

}  // namespace cloth
