#include "report/plot_parts.h"

#include <algorithm>

namespace cloth {
namespace {

constexpr double title_size = 18, subtitle_size = 13, caption_size = 12, caption_line = 16.5, caption_gap = 8;
constexpr double tick_length = 5, minor_length = 3;

const SvgStyle axis_style() {
  return {.stroke = page_colours().muted};
}

double inner(double width) {
  return width - 2 * plot_margin;
}

/// Where the segment enters and leaves the box, as shares of its length; first > second: it misses the box.
std::pair<double, double> inside(SvgPoint a, SvgPoint b, const Box& box) {
  double enter = 0, leave = 1;
  const auto cut = [&](double from, double to, double low, double high) {
    if (from == to) {
      if (from < low || from > high) enter = 2;
      return;
    }
    const double one = (low - from) / (to - from), other = (high - from) / (to - from);
    enter = std::max(enter, std::min(one, other)), leave = std::min(leave, std::max(one, other));
  };
  cut(a.x, b.x, box.left, box.right);
  cut(a.y, b.y, box.top, box.bottom);
  return {enter, leave};
}

/// Draws them unless `svg` is null; returns where they end.
double lay_titles(PlotCanvas* svg, const std::string& title, const std::string& subtitle, double width) {
  double y = plot_margin;
  for (const std::string& line : wrapped(title, title_size * 1.08, inner(width))) {
    if (svg) svg->text({plot_margin, y + 16}, {.text = line, .size = title_size, .bold = true});
    y += 23;
  }
  const PageColour& muted = page_colours().muted;
  for (const std::string& line : wrapped(subtitle, subtitle_size, inner(width))) {
    if (svg) svg->text({plot_margin, y + 13}, {.text = line, .size = subtitle_size, .colour = muted});
    y += 18;
  }
  return y + (title.empty() && subtitle.empty() ? 0 : 10);
}

/// Likewise.
double lay_caption(PlotCanvas* svg, const std::vector<std::string>& paragraphs, double top, double width) {
  const PageColour& muted = page_colours().muted;
  double y = top + caption_gap;
  for (const std::string& paragraph : paragraphs) {
    const std::vector<std::string> lines = wrapped(paragraph, caption_size, inner(width));
    for (const std::string& line : lines) {
      if (svg)
        svg->text({plot_margin, y + caption_size}, {.text = line, .size = caption_size, .colour = muted});
      y += caption_line;
    }
    if (!lines.empty()) y += 4;
  }
  return y;
}

/// With its power of ten, beside the axis.
void draw_tick_text(PlotCanvas& svg, SvgPoint at, const Tick& tick, Anchor anchor) {
  svg.text(at, {.text = tick.text,
                .size = tick_size,
                .anchor = anchor,
                .colour = page_colours().muted,
                .superscript = tick.superscript});
}

}  // namespace

int covered(const Box& box, const std::vector<Box>& others) {
  return int(
      std::count_if(others.begin(), others.end(), [&](const Box& other) { return box.overlaps(other); }));
}

std::string clipped_path(const std::vector<SvgPoint>& points, const Box& box) {
  std::string data;
  std::vector<SvgPoint> piece;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const SvgPoint a = points[i - 1], b = points[i];
    const auto [enter, leave] = inside(a, b, box);
    if (enter > leave) continue;
    const auto at = [&](double s) { return SvgPoint{a.x + s * (b.x - a.x), a.y + s * (b.y - a.y)}; };
    if (piece.empty()) piece.push_back(at(enter));
    piece.push_back(leave < 1 ? at(leave) : b);
    if (leave == 1) continue;
    data += path_through(piece);
    piece.clear();
  }
  return data + path_through(piece);
}

double titles_height(const std::string& title, const std::string& subtitle, double width) {
  return lay_titles(nullptr, title, subtitle, width);
}

void draw_titles(PlotCanvas& svg, const std::string& title, const std::string& subtitle, double width) {
  lay_titles(&svg, title, subtitle, width);
}

double caption_height(const std::vector<std::string>& paragraphs, double width) {
  const double height = lay_caption(nullptr, paragraphs, 0, width);
  return height > caption_gap ? height : 0;
}

void draw_caption(PlotCanvas& svg, const std::vector<std::string>& paragraphs, double top, double width) {
  lay_caption(&svg, paragraphs, top, width);
}

double widest_tick(const std::vector<Tick>& ticks) {
  double widest = 0;
  for (const Tick& tick : ticks)
    widest =
        std::max(widest, text_width(tick.text, tick_size) + text_width(tick.superscript, 0.75 * tick_size));
  return widest;
}

void draw_x_axis(PlotCanvas& svg, const AxisMap& map, const std::string& title, const Box& frame, bool grid) {
  svg.begin_group("x-axis");
  std::vector<Tick> ticks = map.ticks(x_tick_spacing);
  const double needed = widest_tick(ticks) + 14;
  if (needed > x_tick_spacing) ticks = map.ticks(needed);
  for (const Tick& tick : ticks) {
    const double x = map.place(tick.value);
    if (grid && tick.major) svg.line({x, frame.top}, {x, frame.bottom}, {.stroke = page_colours().grid});
    svg.line({x, frame.bottom}, {x, frame.bottom + (tick.major ? tick_length : minor_length)}, axis_style());
    if (tick.major) draw_tick_text(svg, {x, frame.bottom + tick_length + 14}, tick, Anchor::middle);
  }
  if (!title.empty())
    svg.text({(frame.left + frame.right) / 2, frame.bottom + 39},
             {.text = title, .size = label_size, .anchor = Anchor::middle});
  svg.end_group();
}

void draw_y_axis(PlotCanvas& svg, const AxisMap& map, const std::string& title, const Box& frame, bool grid) {
  svg.begin_group("y-axis");
  const std::vector<Tick> ticks = map.ticks(y_tick_spacing);
  for (const Tick& tick : ticks) {
    const double y = map.place(tick.value);
    if (grid && tick.major) svg.line({frame.left, y}, {frame.right, y}, {.stroke = page_colours().grid});
    svg.line({frame.left - (tick.major ? tick_length : minor_length), y}, {frame.left, y}, axis_style());
    if (tick.major) draw_tick_text(svg, {frame.left - tick_length - 4, y + 4}, tick, Anchor::end);
  }
  if (!title.empty())
    svg.text({frame.left - tick_length - widest_tick(ticks) - 18, (frame.top + frame.bottom) / 2},
             {.text = title, .size = label_size, .anchor = Anchor::middle, .turn = -90});
  svg.end_group();
}

std::string value_line(const Axis& axis, double value) {
  return (axis.label.empty() ? "" : axis.label + ": ") + short_number(value) +
         (axis.unit.empty() ? "" : " " + axis.unit);
}

}  // namespace cloth
