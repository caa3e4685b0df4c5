#include "report/line_plot.h"

#include <algorithm>

#include "report/line_plot_layout.h"

namespace cloth {
namespace {

constexpr double marker_radius = 4.2, line_width = 1.9;
constexpr double swatch_half = 17;

SvgStyle best_style() {
  return {.stroke = page_colours().muted, .stroke_width = 6, .opacity = 0.25};
}

SvgStyle marker_style(const SeriesStyle& look) {
  if (is_stroke_only(look.marker)) return {.stroke = look.colour, .stroke_width = 2.4};
  return {.fill = look.colour, .stroke = page_colours().surface};
}

SvgStyle hollow_style(const PageColour& colour) {
  return {.fill = page_colours().surface, .stroke = colour, .stroke_width = 1.7};
}

void draw_floor(PlotCanvas& svg, const LineLayout& layout) {
  if (!layout.has_floor()) return;
  const Box& frame = layout.frame;
  const double y = layout.place_y(layout.plot.floor->y);
  svg.begin_group("floor");
  svg.rect({frame.left, y}, frame.width(), frame.bottom - y, {.fill = page_colours().band});
  svg.line({frame.left, y}, {frame.right, y}, {.stroke = page_colours().muted, .dash = Dash::dashed});
  svg.end_group();
}

/// Below its edge, or above where the grey is too thin for text.
void draw_floor_label(PlotCanvas& svg, const LineLayout& layout) {
  if (!layout.has_floor()) return;
  const double y = layout.place_y(layout.plot.floor->y);
  const bool inside = layout.frame.bottom - y > 20;
  svg.text({layout.frame.left + 8, inside ? y + 15 : y - 6}, {.text = layout.plot.floor->label,
                                                              .size = small_size,
                                                              .colour = page_colours().muted,
                                                              .halo = !inside});
}

/// The baseline of a line's label: at one of both ends or in the middle, where it covers least.
void draw_line_label(PlotCanvas& svg, const LineLayout& layout, const ReferenceLine& line, double at,
                     const std::vector<Box>& data) {
  const Box& frame = layout.frame;
  const bool across = line.direction == ReferenceLine::Direction::horizontal;
  const double length = text_width(line.label, small_size);
  const double low = across ? frame.left + 6 : frame.top + 6;
  const double high = (across ? frame.right : frame.bottom) - 6 - length;
  double best = low;
  int least = -1;
  for (const double start : {across ? high : low, across ? low : high, (low + high) / 2}) {
    const Box box = across ? Box{start - 8, at - 17, start + length + 8, at - 3}
                           : Box{at - 17, start, at - 3, start + length};
    const int count = covered(box, data);
    if (least < 0 || count < least) least = count, best = start;
  }
  SvgText text{.text = line.label, .size = small_size, .colour = page_colours().muted, .halo = true};
  if (!across) text.turn = -90, text.anchor = Anchor::end;
  svg.text(across ? SvgPoint{best, at - 5} : SvgPoint{at - 5, best}, text);
}

void draw_reference_lines(PlotCanvas& svg, const LineLayout& layout) {
  const Box& frame = layout.frame;
  const SvgStyle style{.stroke = page_colours().muted, .stroke_width = 1.2, .dash = Dash::dash_dotted};
  const std::vector<Box> data = layout.data_boxes();
  svg.begin_group("reference-lines");
  for (const ReferenceLine& line : layout.plot.lines) {
    const bool across = line.direction == ReferenceLine::Direction::horizontal;
    if (!(across ? layout.y : layout.x).holds(line.at)) continue;
    const double at = (across ? layout.y : layout.x).place(line.at);
    if (across)
      svg.line({frame.left, at}, {frame.right, at}, style);
    else
      svg.line({at, frame.top}, {at, frame.bottom}, style);
    draw_line_label(svg, layout, line, at, data);
  }
  svg.end_group();
}

void draw_best(PlotCanvas& svg, const LineLayout& layout) {
  if (layout.plot.best_line.empty()) return;
  const double lowest = layout.has_floor() ? layout.place_y(layout.plot.floor->y) : layout.frame.bottom;
  std::vector<SvgPoint> points;
  for (const PlotSeries& series : layout.plot.series)
    for (const PlotPoint& point : series.points)
      if (layout.x.holds(point.x) && layout.y.holds(point.y))
        points.push_back({layout.x.place(point.x), std::min(layout.y.place(point.y), lowest)});
  std::sort(points.begin(), points.end(),
            [](SvgPoint a, SvgPoint b) { return a.x != b.x ? a.x < b.x : a.y > b.y; });
  // A staircase: between two runs nothing better than the cheaper one is known.
  std::vector<SvgPoint> stairs;
  for (const SvgPoint& p : points) {
    if (!stairs.empty() && p.y <= stairs.back().y) continue;
    if (!stairs.empty()) stairs.push_back({p.x, stairs.back().y});
    stairs.push_back(p);
  }
  if (!stairs.empty()) stairs.push_back({layout.frame.right, stairs.back().y});
  svg.begin_group("best");
  svg.path(path_through(stairs), best_style());
  svg.end_group();
}

void draw_error_bars(PlotCanvas& svg, const LineLayout& layout, const PlotPoint& point,
                     const SvgStyle& style) {
  const auto drawable = [](AxisScale scale, const std::optional<std::pair<double, double>>& range) {
    return range && can_show(scale, range->first) && can_show(scale, range->second);
  };
  const SvgPoint at{layout.x.place(point.x), layout.y.place(point.y)};
  std::string data;
  if (drawable(layout.plot.x.scale, point.x_range)) {
    const double a = layout.place_x(point.x_range->first), b = layout.place_x(point.x_range->second);
    data += path_through({{a, at.y}, {b, at.y}});
    for (const double end : {a, b}) data += path_through({{end, at.y - 3}, {end, at.y + 3}});
  }
  if (drawable(layout.plot.y.scale, point.y_range)) {
    const double a = layout.place_y(point.y_range->first), b = layout.place_y(point.y_range->second);
    data += path_through({{at.x, a}, {at.x, b}});
    for (const double end : {a, b}) data += path_through({{at.x - 3, end}, {at.x + 3, end}});
  }
  svg.path(data, style);
}

void draw_series(PlotCanvas& svg, const LineLayout& layout, std::size_t index) {
  const LinePlot& plot = layout.plot;
  const PlotSeries& series = plot.series[index];
  const SeriesStyle look = layout.style_of(index);
  svg.begin_group("series");
  if (series.line)
    for (const std::vector<SvgPoint>& stroke : layout.strokes(series))
      svg.path(clipped_path(stroke, layout.frame),
               {.stroke = look.colour, .stroke_width = line_width, .dash = look.dash});
  for (const PlotPoint& point : series.points) {
    if (!layout.x.holds(point.x) || !layout.y.holds(point.y)) continue;
    draw_error_bars(svg, layout, point, {.stroke = look.colour, .opacity = 0.75});
    if (!series.markers) continue;
    std::string tooltip = series.name.empty() ? "" : series.name + "\n";
    tooltip += value_line(plot.x, point.x) + "\n" + value_line(plot.y, point.y);
    if (!point.note.empty()) tooltip += "\n" + point.note;
    svg.marker(look.marker, {layout.x.place(point.x), layout.y.place(point.y)}, marker_radius,
               marker_style(look), {tooltip, point.tag});
  }
  svg.end_group();
}

void draw_failures(PlotCanvas& svg, const LineLayout& layout) {
  if (layout.failures.empty()) return;
  const Box& frame = layout.frame;
  svg.begin_group("failed");
  svg.rect({frame.left, layout.lane_top}, frame.width(), frame.top - layout.lane_top,
           {.fill = page_colours().band});
  svg.text({frame.left - 9, (layout.lane_top + frame.top) / 2 + 4},
           {.text = "failed", .size = tick_size, .anchor = Anchor::end, .colour = page_colours().muted});
  for (const FailureMark& failure : layout.failures) {
    const SeriesStyle look = layout.style_of(failure.series);
    const std::string& name = layout.plot.series[failure.series].name;
    std::string tooltip = name.empty() ? "failed" : name + ": failed";
    if (can_show(layout.plot.x.scale, failure.point->x))
      tooltip += "\n" + value_line(layout.plot.x, failure.point->x);
    if (!failure.point->cause.empty()) tooltip += "\n" + failure.point->cause;
    svg.marker(look.marker, {failure.x, frame.top - 3 - (failure.row + 0.5) * failure_row},
               marker_radius - 0.4, hollow_style(look.colour), {tooltip, failure.point->tag});
  }
  svg.end_group();
}

void draw_triangles(PlotCanvas& svg, const LineLayout& layout) {
  svg.begin_group("slopes");
  for (const PlacedTriangle& triangle :
       place_triangles(layout.plot.triangles, layout.x, layout.y, layout.frame, layout.occupied())) {
    svg.path(path_through({triangle.along, triangle.corner, triangle.up}, true),
             {.fill = page_colours().band, .stroke = page_colours().muted, .stroke_width = 1.1});
    svg.text(triangle.label, {.text = triangle.text, .size = small_size, .colour = page_colours().muted});
  }
  svg.end_group();
}

void draw_swatch(PlotCanvas& svg, const LineLayout& layout, const LegendEntry& entry, SvgPoint centre) {
  const SvgPoint left{centre.x - swatch_half, centre.y}, right{centre.x + swatch_half, centre.y};
  if (entry.kind == LegendEntry::Kind::best) {
    svg.line(left, right, best_style());
  } else if (entry.kind == LegendEntry::Kind::failed) {
    svg.marker(Marker::circle, centre, marker_radius - 0.4, hollow_style(page_colours().muted));
  } else {
    const PlotSeries& series = layout.plot.series[entry.series];
    const SeriesStyle look = layout.style_of(entry.series);
    if (series.line)
      svg.line(left, right, {.stroke = look.colour, .stroke_width = line_width, .dash = look.dash});
    if (series.markers) svg.marker(look.marker, centre, marker_radius + 0.4, marker_style(look));
  }
}

void draw_legend(PlotCanvas& svg, const LineLayout& layout) {
  const double left = layout.legend_left + legend_swatch_width;
  double y = layout.lane_top;
  svg.begin_group("legend");
  for (const LegendEntry& entry : layout.legend) {
    draw_swatch(svg, layout, entry, {layout.legend_left + swatch_half, y + 8.5});
    for (const std::string& line : entry.name) {
      svg.text({left, y + 13}, {.text = line, .size = label_size});
      y += 17;
    }
    for (const std::string& line : entry.detail) {
      svg.text({left, y + 11}, {.text = line, .size = small_size, .colour = page_colours().muted});
      y += 14.5;
    }
    y += 8;
  }
  svg.end_group();
}

}  // namespace

double height_of(const LinePlot& plot) {
  return LineLayout(plot).height;
}

void draw(PlotCanvas& svg, const LinePlot& plot) {
  const LineLayout layout(plot);
  draw_titles(svg, plot.title, plot.subtitle, plot.width);
  draw_floor(svg, layout);
  draw_x_axis(svg, layout.x, axis_title(plot.x, layout.x.tick_exponent()), layout.frame, true);
  draw_y_axis(svg, layout.y, axis_title(plot.y, layout.y.tick_exponent()), layout.frame, true);
  draw_best(svg, layout);
  draw_triangles(svg, layout);
  svg.rect({layout.frame.left, layout.frame.top}, layout.frame.width(), layout.frame.height(),
           {.stroke = page_colours().muted});
  draw_reference_lines(svg, layout);
  draw_floor_label(svg, layout);
  for (std::size_t i = 0; i < plot.series.size(); ++i) draw_series(svg, layout, i);
  if (layout.is_empty())
    svg.text({(layout.frame.left + layout.frame.right) / 2, (layout.frame.top + layout.frame.bottom) / 2},
             {.text = "no data",
              .size = label_size,
              .anchor = Anchor::middle,
              .colour = page_colours().muted,
              .halo = true});
  draw_failures(svg, layout);
  draw_legend(svg, layout);
  draw_caption(svg, layout.caption, layout.height - caption_height(layout.caption, plot.width) - 4,
               plot.width);
}

}  // namespace cloth
