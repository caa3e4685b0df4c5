#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/points_report.h"
#include "study/study_axis.h"
#include "sweep/contour.h"
#include "sweep/sweep_points.h"
#include "sweep/sweep_report.h"

namespace cloth {
namespace {

constexpr int colour_steps = 9;

/// A picture of more points could not be looked at in a browser.
constexpr std::int64_t most_plotted = 20'000;

/// Viridis (Smith and van der Walt 2015) at nine even steps: read alike on white and on near-black.
constexpr const char* ramp[colour_steps] = {"#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c",
                                            "#28ae80", "#5ec962", "#addc30", "#fde725"};

bool is_of_numbers(const SweepAxis& axis) {
  if (!axis.is_list()) return true;
  return std::all_of(axis.values.begin(), axis.values.end(),
                     [](const auto& row) { return number_of(row.front()).has_value(); });
}

/// The axis of a plot: label and unit as the first of its paths declares them.
Axis axis_of(const SweepPlan& plan, const SweepAxis& axis) {
  Axis shown = plot_axis({.path = axis.paths.front(), .scale = axis.scale}, plan.scene);
  if (axis.paths.size() > 1) shown.label += fmt::format(" (with {} more)", axis.paths.size() - 1);
  return shown;
}

/// The values that a grid takes of an axis, ascending, and of each place in the grid where it stands there.
struct Places {
  std::vector<double> ascending;
  std::vector<std::size_t> place_of;
};

Places places_of(const SweepPoints& points, std::int64_t count, std::int64_t stride, std::size_t path) {
  std::vector<double> values;
  for (std::int64_t k = 0; k < count; ++k)
    values.push_back(number_of(points.values(k * stride)[path]).value_or(0));
  Places places{.ascending = values, .place_of = {}};
  std::sort(places.ascending.begin(), places.ascending.end());
  places.ascending.erase(std::unique(places.ascending.begin(), places.ascending.end()),
                         places.ascending.end());
  for (const double value : values)
    places.place_of.push_back(
        static_cast<std::size_t>(std::lower_bound(places.ascending.begin(), places.ascending.end(), value) -
                                 places.ascending.begin()));
  return places;
}

std::int64_t size_of(const SweepAxis& axis) {
  return axis.is_list() ? std::ssize(axis.values) : axis.count;
}

std::vector<ClassStyle> map_classes(double low, double high) {
  std::vector<ClassStyle> classes;
  const double step = (high - low) / colour_steps;
  // As many digits as tell one step from the next.
  const double steps = step > 0 ? std::max(std::abs(low), std::abs(high)) / step : 1;
  const int digits = std::clamp(1 + static_cast<int>(std::ceil(std::log10(std::max(steps, 1.0)))), 3, 12);
  for (int k = 0; k < colour_steps; ++k)
    classes.push_back({.name = fmt::format("{} to {}", short_number(low + k * step, digits),
                                           short_number(low + (k + 1) * step, digits)),
                       .colour = {fmt::format("viridis{}", k), ramp[k], ramp[k]}});
  classes.push_back({.name = "failed", .colour = page_colours().band, .mark = CellMark::slash});
  classes.push_back({.name = "no value", .colour = page_colours().surface, .mark = CellMark::dot});
  return classes;
}

struct MapRange {
  double low = infinity, high = -infinity;
};

HeatCell map_cell(const PointRow& row, double value, const MapRange& range) {
  const std::string point = fmt::format("point {}: ", row.point);
  if (row.status != PointStatus::finished)
    return {.class_index = colour_steps,
            .note = fmt::format("{}{}: {}", point, name_of(row.status), row.cause),
            .tag = static_cast<int>(row.point)};
  if (!std::isfinite(value))
    return {.class_index = colour_steps + 1,
            .note = point + short_number(value),
            .tag = static_cast<int>(row.point)};
  const double part = range.high > range.low ? (value - range.low) / (range.high - range.low) : 0;
  return {.class_index = std::min(colour_steps - 1, static_cast<int>(part * colour_steps)),
          .note = point + short_number(value),
          .tag = static_cast<int>(row.point)};
}

/// Contours between the colours, where the axes' own scales are straight.
void add_contours(HeatPanel& panel, const HeatMap& map, const std::vector<double>& values,
                  const MapRange& range) {
  const auto scaled = [](std::vector<double> all, AxisScale scale) {
    if (scale == AxisScale::logarithmic)
      for (double& value : all) value = std::log(value);
    return all;
  };
  const auto back = [](double value, AxisScale scale) {
    return scale == AxisScale::logarithmic ? std::exp(value) : value;
  };
  const std::vector<double> x = scaled(map.x_values, map.x.scale), y = scaled(map.y_values, map.y.scale);
  for (int k = 1; k < colour_steps && range.high > range.low; ++k)
    for (const auto& line :
         contour_lines(x, y, values, range.low + (range.high - range.low) * k / colour_steps)) {
      OverlayCurve& curve = panel.curves.emplace_back();
      curve.label = "contours, where colours change";
      for (const auto& [at_x, at_y] : line)
        curve.points.emplace_back(back(at_x, map.x.scale), back(at_y, map.y.scale));
    }
}

std::string caption_of(const SweepResults& results) {
  std::string text = fmt::format("{} of {} points", results.rows.size(), results.points);
  const auto finished = results.counts[static_cast<std::size_t>(PointStatus::finished)];
  if (const auto failed = std::ssize(results.rows) - finished; failed > 0)
    text += fmt::format(", {} of them failed", failed);
  return text + ".";
}

}  // namespace

std::optional<double> number_of(const ParameterValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  return std::nullopt;
}

bool has_curves(const SweepPlan& plan) {
  return plan.axes.size() == 1 && plan.design != SweepDesign::points && is_of_numbers(plan.axes.front());
}

bool has_maps(const SweepPlan& plan) {
  return plan.axes.size() == 2 && plan.design == SweepDesign::grid && is_of_numbers(plan.axes[0]) &&
         is_of_numbers(plan.axes[1]) && size_of(plan.axes[0]) > 1 && size_of(plan.axes[1]) > 1;
}

LinePlot curve_plot(const SweepFolder& folder, const SweepResults& results, std::size_t output) {
  const SweepPlan& plan = folder.plan;
  const SweepPoints points(plan);
  LinePlot plot{.title = plan.outputs[output].name,
                .subtitle = plan.title.empty() ? plan.scene.title : plan.title,
                .caption = {caption_of(results)},
                .x = axis_of(plan, plan.axes.front()),
                .y = {.label = plan.outputs[output].name}};
  PlotSeries& series = plot.series.emplace_back();
  series.name = plan.outputs[output].name;
  for (const PointRow& row : results.rows) {
    const double x = number_of(points.values(row.point).front()).value_or(0);
    const std::string note = fmt::format("point {}", row.point);
    if (row.status != PointStatus::finished)
      series.failed.push_back({.x = x,
                               .cause = fmt::format("{}: {}", name_of(row.status), row.cause),
                               .tag = static_cast<int>(row.point)});
    else
      series.points.push_back(
          {.x = x, .y = row.outputs[output], .note = note, .tag = static_cast<int>(row.point)});
  }
  std::stable_sort(series.points.begin(), series.points.end(),
                   [](const PlotPoint& a, const PlotPoint& b) { return a.x < b.x; });
  return plot;
}

HeatMap output_map(const SweepFolder& folder, const SweepResults& results, std::size_t output) {
  const SweepPlan& plan = folder.plan;
  const SweepPoints points(plan);
  // The first axis goes slowest.
  const std::int64_t rows = size_of(plan.axes[0]), columns = size_of(plan.axes[1]);
  const Places x = places_of(points, rows, columns, 0),
               y = places_of(points, columns, 1, plan.axes[0].paths.size());
  HeatMap map{.title = plan.outputs[output].name,
              .subtitle = plan.title.empty() ? plan.scene.title : plan.title,
              .caption = {caption_of(results)},
              .x = axis_of(plan, plan.axes[0]),
              .y = axis_of(plan, plan.axes[1]),
              .x_values = x.ascending,
              .y_values = y.ascending,
              .columns = 1};
  map.highest = 560;
  MapRange range;
  for (const PointRow& row : results.rows)
    if (std::isfinite(row.outputs[output]))
      range = {std::min(range.low, row.outputs[output]), std::max(range.high, row.outputs[output])};
  map.classes = map_classes(range.low, range.high);
  HeatPanel& panel = map.panels.emplace_back();
  panel.cells.assign(x.ascending.size() * y.ascending.size(), {.class_index = -1});
  std::vector<double> values(panel.cells.size(), std::numeric_limits<double>::quiet_NaN());
  for (const PointRow& row : results.rows) {
    const std::size_t at = y.place_of[static_cast<std::size_t>(row.point % columns)] * x.ascending.size() +
                           x.place_of[static_cast<std::size_t>(row.point / columns)];
    panel.cells[at] = map_cell(row, row.outputs[output], range);
    values[at] = row.outputs[output];
  }
  add_contours(panel, map, values, range);
  return map;
}

std::vector<SweepPlot> sweep_plots(const SweepFolder& folder, const SweepResults& results) {
  std::vector<SweepPlot> plots;
  const bool maps = has_maps(folder.plan);
  if (results.rows.empty() || results.points > most_plotted || !(maps || has_curves(folder.plan)))
    return plots;
  std::vector<std::string> taken;
  for (std::size_t k = 0; k < folder.plan.outputs.size(); ++k) {
    const RunOutput& output = folder.plan.outputs[k];
    plots.push_back(
        {.name = file_stem("sweep", output.name, taken) + ".svg",
         .svg = maps ? to_svg(output_map(folder, results, k)) : to_svg(curve_plot(folder, results, k)),
         .caption = fmt::format("{}: {} of {}", output.name, name_of(output.reduce), output.of)});
  }
  return plots;
}

}  // namespace cloth
