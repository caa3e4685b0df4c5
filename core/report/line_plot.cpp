#include "report/line_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/plot_parts.h"
#include "report/slope_triangles.h"

namespace cloth {
namespace {

constexpr double marker_radius = 4.2, line_width = 1.9;
constexpr double failure_row = 13;  // height of a row of failed runs [px]
constexpr double legend_gap = 22, swatch = 34, legend_text_widest = 220;

bool can_show(const LinePlot& plot, const PlotPoint& point) {
  return can_show(plot.x.scale, point.x) && can_show(plot.y.scale, point.y);
}

SeriesStyle style_of(const LinePlot& plot, std::size_t index) {
  return style_of_series(plot.series[index].style.value_or(int(index)));
}

/// One that failed, where it goes.
struct Failure {
  std::size_t series;
  const FailedPoint* point;
  double x;
  int row;
};

struct LegendEntry {
  std::optional<std::size_t> series{};  // none: see `kind`
  enum class Kind { series, best, failed } kind = Kind::series;
  std::vector<std::string> name{}, detail{};  // lines
  double height() const { return 17.0 * double(name.size()) + 14.5 * double(detail.size()) + 8; }
};

/// Everything that has to be known before the first line is drawn.
class Drawing {
 public:
  explicit Drawing(const LinePlot& plot);
  std::string svg();

 private:
  void collect_legend();
  void lay_out();
  void place_failures();
  std::vector<double> x_values() const;
  std::vector<double> y_values() const;
  std::vector<std::string> caption() const;

  void draw_floor(SvgWriter& svg) const;
  void draw_reference_lines(SvgWriter& svg) const;
  void draw_best(SvgWriter& svg) const;
  void draw_series(SvgWriter& svg, std::size_t index) const;
  void draw_error_bars(SvgWriter& svg, const PlotPoint& point, const SvgStyle& style) const;
  void draw_failures(SvgWriter& svg) const;
  void draw_triangles(SvgWriter& svg) const;
  void draw_legend(SvgWriter& svg) const;
  void draw_swatch(SvgWriter& svg, const LegendEntry& entry, SvgPoint centre) const;

  /// Runs of neighbouring points that can be shown.
  std::vector<std::vector<SvgPoint>> strokes(const PlotSeries& series) const;
  std::vector<Box> occupied() const;
  SvgPoint place(const PlotPoint& point) const { return {x_.place(point.x), y_.place(point.y)}; }
  /// A value that can be shown, moved to the edge where it lies outside.
  double clamped_x(double value) const { return std::clamp(x_.place(value), frame_.left, frame_.right); }
  double clamped_y(double value) const { return std::clamp(y_.place(value), frame_.top, frame_.bottom); }

  const LinePlot& plot_;
  AxisMap x_, y_;
  Box frame_;
  double lane_top_ = 0;  // of the failed runs; the frame's top where none failed
  double legend_left_ = 0, height_ = 0;
  std::vector<LegendEntry> legend_;
  std::vector<Failure> failures_;
};

std::vector<double> Drawing::x_values() const {
  std::vector<double> values;
  for (const PlotSeries& series : plot_.series) {
    for (const PlotPoint& p : series.points) {
      if (!can_show(plot_, p)) continue;
      values.push_back(p.x);
      if (p.x_range) values.insert(values.end(), {p.x_range->first, p.x_range->second});
    }
    for (const FailedPoint& f : series.failed) values.push_back(f.x);
  }
  for (const ReferenceLine& line : plot_.lines)
    if (line.direction == ReferenceLine::Direction::vertical) values.push_back(line.at);
  return values;
}

std::vector<double> Drawing::y_values() const {
  std::vector<double> values;
  for (const PlotSeries& series : plot_.series)
    for (const PlotPoint& p : series.points) {
      if (!can_show(plot_, p)) continue;
      values.push_back(p.y);
      if (p.y_range) values.insert(values.end(), {p.y_range->first, p.y_range->second});
    }
  for (const ReferenceLine& line : plot_.lines)
    if (line.direction == ReferenceLine::Direction::horizontal) values.push_back(line.at);
  if (plot_.floor) values.push_back(plot_.floor->y);
  return values;
}

Drawing::Drawing(const LinePlot& plot)
    : plot_(plot), x_(plot.x, x_values(), 0, 1), y_(plot.y, y_values(), 1, 0) {
  collect_legend();
  lay_out();
}

void Drawing::collect_legend() {
  bool any_failed = false;
  for (std::size_t i = 0; i < plot_.series.size(); ++i) {
    const PlotSeries& series = plot_.series[i];
    any_failed = any_failed || !series.failed.empty();
    if (series.name.empty() && series.detail.empty()) continue;
    LegendEntry entry{.series = i};
    entry.name = wrapped(series.name, label_size, legend_text_widest);
    entry.detail = wrapped(series.detail, small_size, legend_text_widest);
    legend_.push_back(entry);
  }
  if (!plot_.best_line.empty())
    legend_.push_back(
        {.kind = LegendEntry::Kind::best, .name = wrapped(plot_.best_line, label_size, legend_text_widest)});
  if (any_failed) legend_.push_back({.kind = LegendEntry::Kind::failed, .name = {"failed"}});
}

void Drawing::lay_out() {
  double legend_width = 0, legend_height = 0;
  for (const LegendEntry& entry : legend_) {
    for (const std::string& line : entry.name)
      legend_width = std::max(legend_width, text_width(line, label_size));
    for (const std::string& line : entry.detail)
      legend_width = std::max(legend_width, text_width(line, small_size));
    legend_height += entry.height();
  }
  if (!legend_.empty()) legend_width += swatch + legend_gap;
  const double top = titles_height(plot_.title, plot_.subtitle, plot_.width) + 6;
  y_.set_places(plot_.plot_height, 0);  // tick labels depend on the height only
  const double left = plot_margin + widest_tick(y_.ticks(y_tick_spacing)) + 34;
  frame_ = {left, top, std::max(plot_.width - plot_margin - legend_width, left + 120), 0};
  x_.set_places(frame_.left, frame_.right);
  place_failures();
  int rows = 0;
  for (const Failure& failure : failures_) rows = std::max(rows, failure.row + 1);
  lane_top_ = top;
  frame_.top = top + (rows > 0 ? rows * failure_row + 6 : 0);
  frame_.bottom = frame_.top + plot_.plot_height;
  y_.set_places(frame_.bottom, frame_.top);
  legend_left_ = frame_.right + legend_gap;
  height_ = std::max(frame_.bottom + 56, top + legend_height + plot_margin) +
            caption_height(caption(), plot_.width) + 4;
}

void Drawing::place_failures() {
  std::vector<std::vector<double>> rows;
  for (std::size_t i = 0; i < plot_.series.size(); ++i)
    for (const FailedPoint& point : plot_.series[i].failed) {
      const double x = can_show(plot_.x.scale, point.x) ? clamped_x(point.x) : frame_.left;
      std::size_t row = 0;
      const auto free = [&](const std::vector<double>& taken) {
        return std::none_of(taken.begin(), taken.end(), [&](double t) { return std::abs(t - x) < 11; });
      };
      while (row < rows.size() && !free(rows[row])) ++row;
      if (row == rows.size()) rows.emplace_back();
      rows[row].push_back(x);
      failures_.push_back({i, &point, x, int(row)});
    }
}

std::vector<std::string> Drawing::caption() const {
  std::vector<std::string> paragraphs = plot_.caption;
  std::size_t dropped = 0;
  for (const PlotSeries& series : plot_.series)
    for (const PlotPoint& point : series.points) dropped += can_show(plot_, point) ? 0 : 1;
  if (dropped > 0)
    paragraphs.push_back(
        fmt::format("{} left out: {} value that {} cannot show ({}).",
                    dropped == 1 ? "1 point is" : fmt::format("{} points are", dropped),
                    dropped == 1 ? "it has a" : "they have a", dropped == 1 ? "its axis" : "their axes",
                    plot_.x.scale == AxisScale::logarithmic || plot_.y.scale == AxisScale::logarithmic
                        ? "not finite, or zero or negative on a logarithmic axis"
                        : "not finite"));
  return paragraphs;
}

void Drawing::draw_floor(SvgWriter& svg) const {
  if (!plot_.floor || !can_show(plot_.y.scale, plot_.floor->y)) return;
  const double y = clamped_y(plot_.floor->y);
  svg.begin_group("floor");
  svg.rect({frame_.left, y}, frame_.width(), frame_.bottom - y, {.fill = page_colours().band});
  svg.line({frame_.left, y}, {frame_.right, y}, {.stroke = page_colours().muted, .dash = Dash::dashed});
  svg.end_group();
}

void Drawing::draw_reference_lines(SvgWriter& svg) const {
  const SvgStyle style{.stroke = page_colours().muted, .stroke_width = 1.2, .dash = Dash::dash_dotted};
  svg.begin_group("reference-lines");
  for (const ReferenceLine& line : plot_.lines) {
    const bool across = line.direction == ReferenceLine::Direction::horizontal;
    if (!(across ? y_ : x_).holds(line.at)) continue;
    SvgText text{.text = line.label, .size = small_size, .colour = page_colours().muted, .halo = true};
    if (across) {
      const double y = y_.place(line.at);
      svg.line({frame_.left, y}, {frame_.right, y}, style);
      text.anchor = Anchor::end;
      svg.text({frame_.right - 6, y - 5}, text);
    } else {
      const double x = x_.place(line.at);
      svg.line({x, frame_.top}, {x, frame_.bottom}, style);
      text.turn = -90, text.anchor = Anchor::end;
      svg.text({x - 5, frame_.top + 6}, text);
    }
  }
  svg.end_group();
}

void Drawing::draw_best(SvgWriter& svg) const {
  if (plot_.best_line.empty()) return;
  std::vector<SvgPoint> points;
  for (const PlotSeries& series : plot_.series)
    for (const PlotPoint& point : series.points)
      if (can_show(plot_, point)) points.push_back({clamped_x(point.x), clamped_y(point.y)});
  std::sort(points.begin(), points.end(),
            [](SvgPoint a, SvgPoint b) { return a.x != b.x ? a.x < b.x : a.y > b.y; });
  // A staircase: between two runs nothing better than the cheaper one is known.
  std::vector<SvgPoint> stairs;
  for (const SvgPoint& p : points) {
    if (!stairs.empty() && p.y <= stairs.back().y) continue;
    if (!stairs.empty()) stairs.push_back({p.x, stairs.back().y});
    stairs.push_back(p);
  }
  if (!stairs.empty()) stairs.push_back({frame_.right, stairs.back().y});
  svg.begin_group("best");
  svg.path(path_through(stairs), {.stroke = page_colours().muted, .stroke_width = 7, .opacity = 0.28});
  svg.end_group();
}

std::vector<std::vector<SvgPoint>> Drawing::strokes(const PlotSeries& series) const {
  std::vector<std::vector<SvgPoint>> all(1);
  for (const PlotPoint& point : series.points) {
    if (can_show(plot_, point))
      all.back().push_back({clamped_x(point.x), clamped_y(point.y)});
    else if (!all.back().empty())
      all.emplace_back();
  }
  return all;
}

void Drawing::draw_error_bars(SvgWriter& svg, const PlotPoint& point, const SvgStyle& style) const {
  const SvgPoint at = place(point);
  std::string data;
  if (point.x_range && can_show(plot_.x.scale, point.x_range->first) &&
      can_show(plot_.x.scale, point.x_range->second)) {
    const double a = clamped_x(point.x_range->first), b = clamped_x(point.x_range->second);
    data += path_through({{a, at.y}, {b, at.y}});
    for (const double end : {a, b}) data += path_through({{end, at.y - 3}, {end, at.y + 3}});
  }
  if (point.y_range && can_show(plot_.y.scale, point.y_range->first) &&
      can_show(plot_.y.scale, point.y_range->second)) {
    const double a = clamped_y(point.y_range->first), b = clamped_y(point.y_range->second);
    data += path_through({{at.x, a}, {at.x, b}});
    for (const double end : {a, b}) data += path_through({{at.x - 3, end}, {at.x + 3, end}});
  }
  svg.path(data, style);
}

void Drawing::draw_series(SvgWriter& svg, std::size_t index) const {
  const PlotSeries& series = plot_.series[index];
  const SeriesStyle look = style_of(plot_, index);
  svg.begin_group("series");
  if (series.line)
    for (const std::vector<SvgPoint>& stroke : strokes(series))
      if (stroke.size() > 1)
        svg.path(path_through(stroke),
                 {.stroke = look.colour, .stroke_width = line_width, .dash = look.dash});
  for (const PlotPoint& point : series.points) {
    if (!can_show(plot_, point) || !x_.holds(point.x) || !y_.holds(point.y)) continue;
    draw_error_bars(svg, point, {.stroke = look.colour, .opacity = 0.75});
    if (!series.markers) continue;
    const std::string tooltip = (series.name.empty() ? "" : series.name + "\n") +
                                value_line(plot_.x, point.x) + "\n" + value_line(plot_.y, point.y) +
                                (point.note.empty() ? "" : "\n" + point.note);
    const SvgStyle style = is_stroke_only(look.marker)
                               ? SvgStyle{.stroke = look.colour, .stroke_width = 2.4}
                               : SvgStyle{.fill = look.colour, .stroke = page_colours().surface};
    svg.marker(look.marker, place(point), marker_radius, style, tooltip);
  }
  svg.end_group();
}

void Drawing::draw_failures(SvgWriter& svg) const {
  if (failures_.empty()) return;
  svg.begin_group("failed");
  svg.rect({frame_.left, lane_top_}, frame_.width(), frame_.top - lane_top_, {.fill = page_colours().band});
  svg.text({frame_.left - 9, (lane_top_ + frame_.top) / 2 + 4},
           {.text = "failed", .size = tick_size, .anchor = Anchor::end, .colour = page_colours().muted});
  for (const Failure& failure : failures_) {
    const SeriesStyle look = style_of(plot_, failure.series);
    const std::string& name = plot_.series[failure.series].name;
    std::string tooltip = name.empty() ? "failed" : name + ": failed";
    if (can_show(plot_.x.scale, failure.point->x)) tooltip += "\n" + value_line(plot_.x, failure.point->x);
    if (!failure.point->cause.empty()) tooltip += "\n" + failure.point->cause;
    svg.marker(look.marker, {failure.x, frame_.top - 3 - (failure.row + 0.5) * failure_row},
               marker_radius - 0.4,
               {.fill = page_colours().surface, .stroke = look.colour, .stroke_width = 1.7}, tooltip);
  }
  svg.end_group();
}

/// Boxes that cover lines, markers and labels.
std::vector<Box> Drawing::occupied() const {
  std::vector<Box> boxes;
  const auto around = [&](SvgPoint p, double r) { boxes.push_back({p.x - r, p.y - r, p.x + r, p.y + r}); };
  for (const PlotSeries& series : plot_.series)
    for (const std::vector<SvgPoint>& stroke : strokes(series))
      for (std::size_t i = 0; i < stroke.size(); ++i) {
        around(stroke[i], 6);
        if (i == 0 || !series.line) continue;
        const SvgPoint a = stroke[i - 1], b = stroke[i];
        const int steps = std::min(60, int(std::hypot(b.x - a.x, b.y - a.y) / 8));
        for (int k = 1; k < steps; ++k)
          around({a.x + (b.x - a.x) * k / steps, a.y + (b.y - a.y) * k / steps}, 3);
      }
  if (plot_.floor && can_show(plot_.y.scale, plot_.floor->y))
    boxes.push_back({frame_.left, clamped_y(plot_.floor->y), frame_.right, frame_.bottom});
  for (const ReferenceLine& line : plot_.lines) {
    const bool across = line.direction == ReferenceLine::Direction::horizontal;
    if (!(across ? y_ : x_).holds(line.at)) continue;
    const double at = (across ? y_ : x_).place(line.at);
    boxes.push_back(across ? Box{frame_.left, at - 18, frame_.right, at + 2}
                           : Box{at - 18, frame_.top, at + 2, frame_.bottom});
  }
  return boxes;
}

void Drawing::draw_triangles(SvgWriter& svg) const {
  svg.begin_group("slopes");
  for (const PlacedTriangle& t : place_triangles(plot_.triangles, x_, y_, frame_, occupied())) {
    svg.path(path_through({t.along, t.corner, t.up}, true),
             {.fill = page_colours().band, .stroke = page_colours().muted, .stroke_width = 1.1});
    svg.text(t.label, {.text = t.text, .size = small_size, .colour = page_colours().muted});
  }
  svg.end_group();
}

void Drawing::draw_swatch(SvgWriter& svg, const LegendEntry& entry, SvgPoint c) const {
  if (entry.kind == LegendEntry::Kind::best) {
    svg.line({c.x - 13, c.y}, {c.x + 13, c.y},
             {.stroke = page_colours().muted, .stroke_width = 7, .opacity = 0.28});
    return;
  }
  if (entry.kind == LegendEntry::Kind::failed) {
    svg.marker(Marker::circle, c, marker_radius - 0.4,
               {.fill = page_colours().surface, .stroke = page_colours().muted, .stroke_width = 1.7});
    return;
  }
  const PlotSeries& series = plot_.series[*entry.series];
  const SeriesStyle look = style_of(plot_, *entry.series);
  if (series.line)
    svg.line({c.x - 13, c.y}, {c.x + 13, c.y},
             {.stroke = look.colour, .stroke_width = line_width, .dash = look.dash});
  if (!series.markers) return;
  svg.marker(look.marker, c, marker_radius + 0.4,
             is_stroke_only(look.marker) ? SvgStyle{.stroke = look.colour, .stroke_width = 2.4}
                                         : SvgStyle{.fill = look.colour, .stroke = page_colours().surface});
}

void Drawing::draw_legend(SvgWriter& svg) const {
  svg.begin_group("legend");
  double y = lane_top_;
  for (const LegendEntry& entry : legend_) {
    draw_swatch(svg, entry, {legend_left_ + 13, y + 8.5});
    for (const std::string& line : entry.name) {
      svg.text({legend_left_ + swatch, y + 13}, {.text = line, .size = label_size});
      y += 17;
    }
    for (const std::string& line : entry.detail) {
      svg.text({legend_left_ + swatch, y + 11},
               {.text = line, .size = small_size, .colour = page_colours().muted});
      y += 14.5;
    }
    y += 8;
  }
  svg.end_group();
}

std::string Drawing::svg() {
  SvgWriter svg(plot_.width, height_, plot_.title.empty() ? "Plot" : plot_.title);
  draw_titles(svg, plot_.title, plot_.subtitle, plot_.width);
  draw_floor(svg);
  draw_x_axis(svg, x_, axis_title(plot_.x, x_.tick_exponent()), frame_, true);
  draw_y_axis(svg, y_, axis_title(plot_.y, y_.tick_exponent()), frame_, true);
  draw_best(svg);
  draw_triangles(svg);
  svg.rect({frame_.left, frame_.top}, frame_.width(), frame_.height(), {.stroke = page_colours().muted});
  draw_reference_lines(svg);
  for (std::size_t i = 0; i < plot_.series.size(); ++i) draw_series(svg, i);
  if (plot_.floor && can_show(plot_.y.scale, plot_.floor->y))
    svg.text({frame_.left + 8, clamped_y(plot_.floor->y) + 15},
             {.text = plot_.floor->label, .size = small_size, .colour = page_colours().muted, .halo = false});
  draw_failures(svg);
  draw_legend(svg);
  draw_caption(svg, caption(), height_ - caption_height(caption(), plot_.width) - 4, plot_.width);
  return svg.finish();
}

}  // namespace

std::string to_svg(const LinePlot& plot) {
  return Drawing(plot).svg();
}

}  // namespace cloth
