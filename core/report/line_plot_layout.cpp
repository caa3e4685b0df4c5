#include "report/line_plot_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace cloth {
namespace {

constexpr double legend_text_widest = 220;  // [px]

bool can_show(const LinePlot& plot, const PlotPoint& point) {
  return can_show(plot.x.scale, point.x) && can_show(plot.y.scale, point.y);
}

/// Of all points that can be shown, with their error bars, and of the lines across.
std::vector<double> values_of(const LinePlot& plot, double PlotPoint::*place, PlotRange PlotPoint::*range,
                              ReferenceLine::Direction across) {
  std::vector<double> values;
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& p : series.points) {
      if (!can_show(plot, p)) continue;
      values.push_back(p.*place);
      if (p.*range) values.insert(values.end(), {(p.*range)->first, (p.*range)->second});
    }
  for (const ReferenceLine& line : plot.lines)
    if (line.direction == across) values.push_back(line.at);
  return values;
}

std::vector<double> x_values(const LinePlot& plot) {
  auto values = values_of(plot, &PlotPoint::x, &PlotPoint::x_range, ReferenceLine::Direction::vertical);
  for (const PlotSeries& series : plot.series)
    for (const FailedPoint& failed : series.failed) values.push_back(failed.x);
  return values;
}

std::vector<double> y_values(const LinePlot& plot) {
  auto values = values_of(plot, &PlotPoint::y, &PlotPoint::y_range, ReferenceLine::Direction::horizontal);
  if (plot.floor) values.push_back(plot.floor->y);
  return values;
}

/// Curves without markers use the whole width: they need no room beside them.
Axis x_axis_of(const LinePlot& plot, const std::vector<double>& values) {
  Axis axis = plot.x;
  if (axis.scale == AxisScale::logarithmic) return axis;
  if (std::any_of(plot.series.begin(), plot.series.end(), [](const PlotSeries& s) { return s.markers; }))
    return axis;
  std::optional<double> low, high;
  for (const double value : values) {
    if (!can_show(axis.scale, value)) continue;
    low = std::min(low.value_or(value), value), high = std::max(high.value_or(value), value);
  }
  if (!axis.low) axis.low = low;
  if (!axis.high) axis.high = high;
  return axis;
}

}  // namespace

LineLayout::LineLayout(const LinePlot& line_plot)
    : plot(line_plot),
      x(x_axis_of(plot, x_values(plot)), x_values(plot), 0, 1),
      y(plot.y, y_values(plot), 1, 0) {
  collect_legend();
  collect_caption();
  lay_out();
}

bool LineLayout::is_empty() const {
  return std::all_of(plot.series.begin(), plot.series.end(), [&](const PlotSeries& series) {
    return std::none_of(series.points.begin(), series.points.end(),
                        [&](const PlotPoint& point) { return shows(point); });
  });
}

SeriesStyle LineLayout::style_of(std::size_t series) const {
  return style_of_series(plot.series[series].style.value_or(int(series)));
}

double LineLayout::place_x(double value) const {
  return std::clamp(x.place(value), frame.left, frame.right);
}

double LineLayout::place_y(double value) const {
  return std::clamp(y.place(value), frame.top, frame.bottom);
}

void LineLayout::collect_legend() {
  bool any_failed = false;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const PlotSeries& series = plot.series[i];
    any_failed = any_failed || !series.failed.empty();
    if (series.name.empty() && series.detail.empty()) continue;
    LegendEntry entry{LegendEntry::Kind::series, i};
    entry.name = wrapped(series.name, label_size, legend_text_widest);
    entry.detail = wrapped(series.detail, small_size, legend_text_widest);
    legend.push_back(entry);
  }
  if (!plot.best_line.empty())
    legend.push_back(
        {.kind = LegendEntry::Kind::best, .name = wrapped(plot.best_line, label_size, legend_text_widest)});
  if (any_failed) legend.push_back({.kind = LegendEntry::Kind::failed, .name = {"failed"}});
}

void LineLayout::collect_caption() {
  caption = plot.caption;
  std::size_t left_out = 0;
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& point : series.points) left_out += shows(point) ? 0 : 1;
  if (left_out == 0) return;
  const bool logs = plot.x.scale == AxisScale::logarithmic || plot.y.scale == AxisScale::logarithmic;
  caption.push_back(fmt::format("{} left out: not finite{}.",
                                left_out == 1 ? "1 point is" : fmt::format("{} points are", left_out),
                                logs ? ", or zero or negative on a logarithmic axis" : ""));
}

void LineLayout::lay_out() {
  double legend_width = 0, legend_height = 0;
  for (const LegendEntry& entry : legend) {
    for (const std::string& line : entry.name)
      legend_width = std::max(legend_width, text_width(line, label_size));
    for (const std::string& line : entry.detail)
      legend_width = std::max(legend_width, text_width(line, small_size));
    legend_height += entry.height();
  }
  if (!legend.empty()) legend_width += legend_swatch_width + legend_gap;
  const double top = titles_height(plot.title, plot.subtitle, plot.width) + 6;
  y.set_places(plot.plot_height, 0);  // tick labels depend on the height only
  const double left = plot_margin + widest_tick(y.ticks(y_tick_spacing)) + 34;
  frame = {left, top, std::max(plot.width - plot_margin - legend_width, left + 120), 0};
  x.set_places(frame.left, frame.right);
  place_failures();
  int rows = 0;
  for (const FailureMark& failure : failures) rows = std::max(rows, failure.row + 1);
  lane_top = top;
  frame.top = top + (rows > 0 ? rows * failure_row + 6 : 0);
  frame.bottom = frame.top + plot.plot_height;
  y.set_places(frame.bottom, frame.top);
  legend_left = frame.right + legend_gap;
  height = std::max(frame.bottom + 56, top + legend_height + plot_margin) +
           caption_height(caption, plot.width) + 4;
}

void LineLayout::place_failures() {
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < plot.series.size(); ++i)
    for (const FailedPoint& point : plot.series[i].failed) {
      const double at = can_show(plot.x.scale, point.x) ? place_x(point.x) : frame.left;
      std::size_t row = 0;
      const auto free = [&](const std::vector<double>& taken) {
        return std::none_of(taken.begin(), taken.end(), [&](double t) { return std::abs(t - at) < 11; });
      };
      while (row < rows.size() && !free(rows[row])) ++row;
      if (row == rows.size()) rows.emplace_back();
      rows[row].push_back(at);
      failures.push_back({i, &point, at, int(row)});
    }
}

std::vector<std::vector<SvgPoint>> LineLayout::strokes(const PlotSeries& series) const {
  std::vector<std::vector<SvgPoint>> all(1);
  for (const PlotPoint& point : series.points) {
    if (shows(point))
      all.back().push_back({x.place(point.x), y.place(point.y)});
    else if (!all.back().empty())
      all.emplace_back();
  }
  return all;
}

std::vector<Box> LineLayout::data_boxes() const {
  std::vector<Box> boxes;
  const auto around = [&](SvgPoint p, double r) { boxes.push_back({p.x - r, p.y - r, p.x + r, p.y + r}); };
  for (const PlotSeries& series : plot.series)
    for (const std::vector<SvgPoint>& stroke : strokes(series))
      for (std::size_t i = 0; i < stroke.size(); ++i) {
        around(stroke[i], 6);
        if (i == 0 || !series.line) continue;
        const SvgPoint a = stroke[i - 1], b = stroke[i];
        const int steps = std::min(60, int(std::hypot(b.x - a.x, b.y - a.y) / 8));
        for (int k = 1; k < steps; ++k)
          around({a.x + (b.x - a.x) * k / steps, a.y + (b.y - a.y) * k / steps}, 3);
      }
  return boxes;
}

std::vector<Box> LineLayout::occupied() const {
  std::vector<Box> boxes = data_boxes();
  if (has_floor()) boxes.push_back({frame.left, place_y(plot.floor->y), frame.right, frame.bottom});
  for (const ReferenceLine& line : plot.lines) {
    const bool across = line.direction == ReferenceLine::Direction::horizontal;
    if (!(across ? y : x).holds(line.at)) continue;
    const double at = (across ? y : x).place(line.at);
    boxes.push_back(across ? Box{frame.left, at - 18, frame.right, at + 2}
                           : Box{at - 18, frame.top, at + 2, frame.bottom});
  }
  return boxes;
}

}  // namespace cloth
