#include "report/points/scatter_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "report/plot_parts.h"

namespace cloth {
namespace {

constexpr double gap = 8, left_room = 84, bottom_room = 62, most_panel = 230;
constexpr double inset = 5;  // of points within their panel
constexpr std::size_t mean_intervals = 8, histogram_bars = 10;

struct ScatterLayout {
  explicit ScatterLayout(const ScatterMatrix& all) : plot(all) {
    for (std::size_t c = 0; c < plot.table.columns.size(); ++c) {
      const bool is_output = plot.table.columns[c].is_output;
      if (!plot.main_effects || !is_output) across.push_back(c);
      if (!plot.main_effects || is_output) down.push_back(c);
    }
    const auto count = static_cast<double>(std::max<std::size_t>(across.size(), 1));
    const double room = plot.width - left_room - plot_margin - gap * (count - 1);
    panel_width = std::min(room / count, plot.main_effects ? 1.6 * most_panel : most_panel);
    panel_height = plot.main_effects ? std::clamp(panel_width, 110.0, 190.0) : panel_width;
    top = titles_height(plot.title, plot.subtitle, plot.width);
  }

  Box panel(std::size_t row, std::size_t column) const {
    const double x = left_room + (panel_width + gap) * static_cast<double>(column);
    const double y = top + (panel_height + gap) * static_cast<double>(row);
    return {x, y, x + panel_width, y + panel_height};
  }
  const PointColumn& column(std::size_t c) const { return plot.table.columns[c]; }
  double bottom() const { return panel(down.empty() ? 0 : down.size() - 1, 0).bottom + bottom_room; }
  double height() const { return bottom() + caption_height(plot.caption, plot.width) + plot_margin; }

  const ScatterMatrix& plot;
  std::vector<std::size_t> across, down;
  double panel_width = 0, panel_height = 0, top = 0;
};

void draw_points(PlotCanvas& canvas, const ScatterLayout& layout, const AxisMap& x, const AxisMap& y,
                 const PointColumn& of_x, const PointColumn& of_y) {
  std::string circles;  // one path: hundreds of elements in each of dozens of panels are slow to draw
  for (const std::size_t row : layout.plot.table.some_rows(most_scatter_points)) {
    const double a = of_x.values[row], b = of_y.values[row];
    if (can_show(x.scale(), a) && can_show(y.scale(), b))
      circles += marker_path(Marker::circle, {x.place(a), y.place(b)}, layout.plot.main_effects ? 1.9 : 1.6);
  }
  const double opacity = layout.plot.table.rows() > 250 ? 0.5 : 0.85;
  canvas.path(circles, {.fill = style_of_series(0).colour, .opacity = opacity});
}

void draw_mean(PlotCanvas& canvas, const AxisMap& x, const AxisMap& y, const PointColumn& of_x,
               const PointColumn& of_y) {
  std::vector<SvgPoint> line;
  for (const SvgPoint& mean : mean_along(of_x.values, of_y.values, mean_intervals))
    if (can_show(x.scale(), mean.x) && can_show(y.scale(), mean.y))
      line.push_back({x.place(mean.x), y.place(mean.y)});
  const PageColour& colour = style_of_series(1).colour;
  canvas.path(path_through(line), {.stroke = colour, .stroke_width = 2.2});
  for (const SvgPoint& point : line) canvas.marker(Marker::square, point, 2.6, {.fill = colour});
}

/// Bars from the lowest value to the highest.
void draw_histogram(PlotCanvas& canvas, const AxisMap& x, const PointColumn& column, const Box& box) {
  std::vector<double> places;
  for (const double value : column.values)
    if (x.holds(value)) places.push_back(x.place(value));
  if (places.empty()) return;
  const auto [low, high] = std::minmax_element(places.begin(), places.end());
  const double from = *low, bar = std::max((*high - from) / histogram_bars, 2.0);
  std::array<std::size_t, histogram_bars> counts{};
  for (const double place : places)
    ++counts[std::min(static_cast<std::size_t>((place - from) / bar), histogram_bars - 1)];
  const auto most = static_cast<double>(*std::max_element(counts.begin(), counts.end()));
  for (std::size_t k = 0; k < histogram_bars; ++k) {
    const double height = 0.9 * box.height() * static_cast<double>(counts[k]) / most;
    canvas.rect({from + bar * static_cast<double>(k) + 0.5, box.bottom - height}, bar - 1, height,
                {.fill = page_colours().muted, .opacity = 0.45}, fmt::format("{} runs", counts[k]));
  }
}

/// In the middle of a panel, larger the stronger it is.
void draw_correlation(PlotCanvas& canvas, const PointColumn& a, const PointColumn& b, const Box& box) {
  const double correlation = rank_correlation(a.values, b.values);
  if (!std::isfinite(correlation)) return;
  const double size = std::min(12 + 8 * std::abs(correlation), 0.3 * box.width());
  std::string text = fmt::format("{:.2f}", std::abs(correlation));
  if (correlation < 0 && text != "0.00") text = "−" + text;
  canvas.text({(box.left + box.right) / 2, (box.top + box.bottom) / 2 + size / 3},
              {.text = text,
               .size = size,
               .anchor = Anchor::middle,
               .bold = std::abs(correlation) >= 0.5,
               .colour = std::abs(correlation) >= 0.2 ? page_colours().ink : page_colours().muted});
}

void draw_panel(PlotCanvas& canvas, const ScatterLayout& layout, std::size_t row, std::size_t column) {
  const Box box = layout.panel(row, column);
  const PointColumn &of_x = layout.column(layout.across[column]), &of_y = layout.column(layout.down[row]);
  const AxisMap x = map_of(of_x, box.left + inset, box.right - inset),
                y = map_of(of_y, box.bottom - inset, box.top + inset);
  canvas.rect({box.left, box.top}, box.width(), box.height(), {.stroke = page_colours().grid});
  if (layout.plot.main_effects) {
    draw_points(canvas, layout, x, y, of_x, of_y);
    draw_mean(canvas, x, y, of_x, of_y);
  } else if (row == column) {
    draw_histogram(canvas, x, of_x, box);
  } else if (row > column) {
    draw_points(canvas, layout, x, y, of_x, of_y);
  } else {
    draw_correlation(canvas, of_x, of_y, box);
  }
}

/// Ticks with texts below or left of a panel: closer than on a large plot.
void draw_panel_ticks(PlotCanvas& canvas, const AxisMap& map, const Box& box, bool below) {
  const std::vector<Tick> rough = map.ticks(40);
  for (const Tick& tick : map.ticks(below ? std::max(40.0, widest_tick(rough) + 12) : 26)) {
    const double place = map.place(tick.value), length = tick.major ? 5 : 3;
    if (below)
      canvas.line({place, box.bottom}, {place, box.bottom + length}, {.stroke = page_colours().muted});
    else
      canvas.line({box.left - length, place}, {box.left, place}, {.stroke = page_colours().muted});
    if (!tick.major) continue;
    canvas.text(below ? SvgPoint{place, box.bottom + 18} : SvgPoint{box.left - 8, place + 4},
                {.text = tick.text,
                 .size = tick_size,
                 .anchor = below ? Anchor::middle : Anchor::end,
                 .colour = page_colours().muted,
                 .superscript = tick.superscript});
  }
}

/// The name of a column in the middle of `box`, from `place` on downwards, or to the right where it is
/// turned.
void draw_column_name(PlotCanvas& canvas, const PointColumn& column, const Box& box, double place,
                      bool turned) {
  for (const std::string& line : column_title(column, turned ? box.height() : box.width())) {
    const SvgPoint at =
        turned ? SvgPoint{place, (box.top + box.bottom) / 2} : SvgPoint{(box.left + box.right) / 2, place};
    canvas.text(at, {.text = line,
                     .size = small_size,
                     .anchor = Anchor::middle,
                     .bold = column.is_output,
                     .turn = turned ? -90.0 : 0.0});
    place += 14;
  }
}

/// Ticks and names below the lowest panels and left of the first ones.
void draw_outer_axes(PlotCanvas& canvas, const ScatterLayout& layout) {
  canvas.begin_group("axes");
  for (std::size_t k = 0; k < layout.across.size(); ++k) {
    const Box box = layout.panel(layout.down.size() - 1, k);
    const PointColumn& column = layout.column(layout.across[k]);
    draw_panel_ticks(canvas, map_of(column, box.left + inset, box.right - inset), box, true);
    draw_column_name(canvas, column, box, box.bottom + 36, false);
  }
  for (std::size_t k = 0; k < layout.down.size(); ++k) {
    const Box box = layout.panel(k, 0);
    const PointColumn& column = layout.column(layout.down[k]);
    if (layout.plot.main_effects || k > 0)  // the first panel's height counts runs
      draw_panel_ticks(canvas, map_of(column, box.bottom - inset, box.top + inset), box, false);
    draw_column_name(canvas, column, box, plot_margin + 8, true);
  }
  canvas.end_group();
}

/// The means of neighbours in pairs that are sorted by the first.
std::vector<SvgPoint> means_of(const std::vector<std::pair<double, double>>& pairs, std::size_t intervals) {
  std::vector<SvgPoint> means;
  for (std::size_t k = 0; k < intervals; ++k) {
    const std::size_t from = k * pairs.size() / intervals, to = (k + 1) * pairs.size() / intervals;
    SvgPoint sum{0, 0};
    for (std::size_t i = from; i < to; ++i) sum.x += pairs[i].first, sum.y += pairs[i].second;
    const auto count = static_cast<double>(to - from);
    if (to > from) means.push_back({sum.x / count, sum.y / count});
  }
  return means;
}

}  // namespace

std::vector<SvgPoint> mean_along(const std::vector<double>& x, const std::vector<double>& y,
                                 std::size_t intervals) {
  std::vector<std::pair<double, double>> pairs;
  std::set<double> values;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    pairs.emplace_back(x[i], y[i]);
    if (values.size() <= intervals) values.insert(x[i]);
  }
  std::sort(pairs.begin(), pairs.end());
  if (values.size() > intervals) return means_of(pairs, intervals);
  std::vector<SvgPoint> means;
  for (const double value : values) {
    std::vector<std::pair<double, double>> same;
    for (const auto& pair : pairs)
      if (pair.first == value) same.push_back(pair);
    means.push_back({value, means_of(same, 1).front().y});
  }
  return means;
}

double height_of(const ScatterMatrix& plot) {
  return ScatterLayout(plot).height();
}

void draw(PlotCanvas& canvas, const ScatterMatrix& plot) {
  const ScatterLayout layout(plot);
  draw_titles(canvas, plot.title, plot.subtitle, plot.width);
  if (layout.across.empty() || layout.down.empty()) return;
  for (std::size_t row = 0; row < layout.down.size(); ++row)
    for (std::size_t column = 0; column < layout.across.size(); ++column)
      draw_panel(canvas, layout, row, column);
  draw_outer_axes(canvas, layout);
  draw_caption(canvas, plot.caption, layout.bottom(), plot.width);
}

}  // namespace cloth
