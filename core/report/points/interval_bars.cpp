#include "report/points/interval_bars.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/plot_parts.h"

namespace cloth {
namespace {

constexpr double bar_height = 15, category_gap = 14, bar_legend_height = 30, name_size = 12.5,
                 value_room = 64;

struct BarLayout {
  explicit BarLayout(const IntervalBars& all)
      : plot(all),
        map(with_zero(all.x), values_of(all), 0, 1),
        top(titles_height(all.title, all.subtitle, all.width)) {
    double widest = 0;
    for (const std::string& name : plot.categories) widest = std::max(widest, text_width(name, name_size));
    frame.left = plot_margin + std::min(widest, 0.4 * plot.width) + 10;
    frame.right = plot.width - plot_margin - value_room;
    frame.top = top + bar_legend_height;
    frame.bottom =
        frame.top + category_gap / 2 + category_height() * static_cast<double>(plot.categories.size());
    map.set_places(frame.left, frame.right);
  }

  static Axis with_zero(Axis axis) {
    axis.scale = AxisScale::linear;
    return axis;
  }
  static std::vector<double> values_of(const IntervalBars& plot) {
    std::vector<double> values{0};
    for (const BarSeries& series : plot.series)
      for (const IntervalBar& bar : series.bars) values.insert(values.end(), {bar.value, bar.low, bar.high});
    return values;
  }

  double category_height() const {
    return bar_height * static_cast<double>(plot.series.size()) + category_gap;
  }
  double bar_top(std::size_t category, std::size_t series) const {
    return frame.top + category_gap / 2 + category_height() * static_cast<double>(category) +
           bar_height * static_cast<double>(series);
  }
  double bottom() const { return frame.bottom + 46; }
  double height() const { return bottom() + caption_height(plot.caption, plot.width) + plot_margin; }

  const IntervalBars& plot;
  AxisMap map;
  double top;
  Box frame;
};

void draw_bar(PlotCanvas& canvas, const BarLayout& layout, std::size_t category, std::size_t s) {
  const BarSeries& series = layout.plot.series[s];
  if (category >= series.bars.size() || !std::isfinite(series.bars[category].value)) return;
  const IntervalBar& bar = series.bars[category];
  const double top = layout.bar_top(category, s), zero = layout.map.place(0),
               end = layout.map.place(bar.value);
  const bool has_interval = std::isfinite(bar.low) && std::isfinite(bar.high);
  std::string tip = layout.plot.categories[category] + "\n" + series.name + ": " + short_number(bar.value);
  if (has_interval) tip += "\n95 % interval: " + short_number(bar.low) + " to " + short_number(bar.high);
  canvas.rect({std::min(zero, end), top + 1.5}, std::max(std::abs(end - zero), 1.0), bar_height - 3,
              {.fill = style_of_series(static_cast<int>(s)).colour}, tip);
  double right = std::max(zero, end);
  if (has_interval) {
    const double a = layout.map.place(bar.low), b = layout.map.place(bar.high), y = top + bar_height / 2;
    const auto strokes = [&](const SvgStyle& style) {
      canvas.line({a, y}, {b, y}, style);
      for (const double x : {a, b}) canvas.line({x, y - 4}, {x, y + 4}, style);
    };
    strokes({.stroke = page_colours().surface, .stroke_width = 3.5});  // seen on the bar too
    strokes({.stroke = page_colours().ink, .stroke_width = 1.4});
    right = std::max(right, b);
  }
  const int decimals =
      std::clamp(2 - static_cast<int>(std::floor(std::log10(layout.map.high() - layout.map.low()))), 0, 9);
  std::string text = fmt::format("{:.{}f}", bar.value, decimals);
  if (bar.value < 0) text.replace(0, 1, "−");
  canvas.text({right + 6, top + bar_height - 3.5},
              {.text = text, .size = 11, .colour = page_colours().muted});
}

void draw_bar_legend(PlotCanvas& canvas, const BarLayout& layout) {
  double x = layout.frame.left;
  canvas.begin_group("legend");
  for (std::size_t s = 0; s < layout.plot.series.size(); ++s) {
    const std::string& name = layout.plot.series[s].name;
    canvas.rect({x, layout.top + 2}, 14, 12, {.fill = style_of_series(static_cast<int>(s)).colour});
    canvas.text({x + 20, layout.top + 12}, {.text = name, .size = small_size});
    x += 20 + text_width(name, small_size) + 22;
  }
  canvas.end_group();
}

}  // namespace

double height_of(const IntervalBars& plot) {
  return BarLayout(plot).height();
}

void draw(PlotCanvas& canvas, const IntervalBars& plot) {
  const BarLayout layout(plot);
  draw_titles(canvas, plot.title, plot.subtitle, plot.width);
  draw_bar_legend(canvas, layout);
  draw_x_axis(canvas, layout.map, axis_title(plot.x, layout.map.tick_exponent()), layout.frame, true);
  canvas.begin_group("bars");
  for (std::size_t category = 0; category < plot.categories.size(); ++category) {
    const double middle =
        layout.bar_top(category, 0) + bar_height * static_cast<double>(plot.series.size()) / 2;
    canvas.text({layout.frame.left - 10, middle + 4},
                {.text = plot.categories[category], .size = name_size, .anchor = Anchor::end});
    for (std::size_t s = 0; s < plot.series.size(); ++s) draw_bar(canvas, layout, category, s);
  }
  canvas.end_group();
  const double zero = layout.map.place(0);
  canvas.line({zero, layout.frame.top}, {zero, layout.frame.bottom}, {.stroke = page_colours().ink});
  draw_caption(canvas, plot.caption, layout.bottom(), plot.width);
}

}  // namespace cloth
