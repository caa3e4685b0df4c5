#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/grid_convergence_report.h"
#include "study/run_output.h"

namespace cloth {
namespace {

/// What an output's values are drawn over where several share an axis: its limit, else its finest value.
double scale_of(const GridConvergence& study, std::size_t output) {
  const Richardson found = richardson_of(study, output);
  if (std::isfinite(found.extrapolate) && found.extrapolate != 0) return found.extrapolate;
  const auto values = grid_values(study, output, study.runs.size());
  const double finest = values.empty() ? 0 : values.back().value;
  return finest != 0 ? finest : 1;
}

std::string note_of(const GridRun& run, double value) {
  std::string note = fmt::format("{} x {} cells, value {:.8g}\nstep {:.4g} s, {} steps", run.columns - 1,
                                 run.rows - 1, value, run.time_step, run.steps);
  return run.detail.empty() ? note : note + "\n" + run.detail;
}

std::string legend_of(const Richardson& found) {
  if (found.verdict == GridVerdict::two_grids) return fmt::format("order {:.3g} assumed", found.order);
  if (found.verdict != GridVerdict::converging) return name_of(found.verdict);
  return fmt::format("order {:.2f}{}", found.order, found.is_asymptotic ? ", settled" : "");
}

std::vector<FailedPoint> failed_points(const GridConvergence& study) {
  std::vector<FailedPoint> failed;
  for (std::size_t k = 0; k < study.runs.size(); ++k)
    if (const GridRun& run = study.runs[k]; run.status != GridRunStatus::finished)
      failed.push_back({run.cell, std::string(name_of(run.status)) + ": " + run.detail,
                        run.status == GridRunStatus::refused ? -1 : static_cast<int>(k)});
  return failed;
}

/// The output's values less `origin`, over `scale`; of errors the size.
PlotSeries series_of(const GridConvergence& study, std::size_t output, double origin, double scale,
                     bool are_errors) {
  PlotSeries series{.name = words_of_output(study.outputs[output]),
                    .detail = legend_of(richardson_of(study, output)),
                    .failed = failed_points(study),
                    .style = static_cast<int>(output)};
  for (std::size_t k = 0; k < study.runs.size(); ++k) {
    const GridRun& run = study.runs[k];
    const double value = run.values[output];
    if (!std::isfinite(value)) continue;
    const double shown = (value - origin) / scale;
    series.points.push_back({.x = run.cell,
                             .y = are_errors ? std::abs(shown) : shown,
                             .note = note_of(run, value),
                             .tag = static_cast<int>(k)});
  }
  return series;
}

/// The extrapolated value, at cells without size, with the finest value's error around it.
PlotSeries limit_of(const GridConvergence& study, std::size_t output, double scale) {
  const Richardson found = richardson_of(study, output);
  PlotSeries series{.name = "extrapolated", .style = static_cast<int>(output), .line = false};
  if (!std::isfinite(found.extrapolate)) return series;
  const double at = found.extrapolate / scale, reach = std::abs(found.band / scale);
  PlotPoint point{.x = 0, .y = at, .note = fmt::format("{:.8g}", found.extrapolate)};
  if (std::isfinite(found.band)) point.y_range = {at - reach, at + reach};
  series.points.push_back(point);
  return series;
}

Axis cell_axis(AxisScale scale) {
  Axis axis{.label = "length of a cell", .unit = "m", .scale = scale};
  if (scale == AxisScale::linear) axis.low = 0;
  return axis;
}

LinePlot values_plot(const GridConvergence& study, const std::vector<std::size_t>& outputs) {
  LinePlot plot{.title = "Value against cell size", .subtitle = study.scene.title};
  plot.x = cell_axis(AxisScale::linear);
  const bool is_alone = outputs.size() == 1;
  if (is_alone)
    plot.y = {.label = name_of_output(study.outputs[outputs.front()]),
              .unit = unit_of_output(study.outputs[outputs.front()])};
  else
    plot.y = {.label = "value, relative"};
  for (const std::size_t output : outputs) {
    const double scale = is_alone ? 1 : scale_of(study, output);
    plot.series.push_back(series_of(study, output, 0, scale, false));
    PlotSeries limit = limit_of(study, output, scale);
    if (is_alone && !limit.points.empty())
      plot.lines.push_back(
          {.at = limit.points.front().y, .label = fmt::format("{:.6g}", limit.points.front().y)});
    if (!is_alone) limit.name = plot.series.back().name + ", extrapolated";
    if (!limit.points.empty()) plot.series.push_back(std::move(limit));
  }
  plot.caption = {
      "At 0: the value that Richardson's extrapolation of the finest three grids gives; its bar is the error "
      "of the finest value (grid convergence index)."};
  if (!is_alone)
    plot.caption.emplace_back(
        "Each output over its extrapolated value; where there is none, over its finest value.");
  return plot;
}

LinePlot errors_plot(const GridConvergence& study, const std::vector<std::size_t>& outputs) {
  LinePlot plot{.title = "Error against cell size", .subtitle = study.scene.title};
  plot.x = cell_axis(AxisScale::logarithmic);
  const bool is_alone = outputs.size() == 1;
  plot.y = {.label = is_alone ? "error" : "error, relative",
            .unit = is_alone ? unit_of_output(study.outputs[outputs.front()]) : "",
            .scale = AxisScale::logarithmic};
  for (const std::size_t output : outputs) {
    const Richardson found = richardson_of(study, output);
    const std::string name = words_of_output(study.outputs[output]);
    if (found.verdict == GridVerdict::converging) {
      plot.series.push_back(
          series_of(study, output, found.extrapolate, is_alone ? 1 : scale_of(study, output), true));
      continue;
    }
    plot.series.push_back({.name = name,
                           .detail = std::string("no order: ") + name_of(found.verdict),
                           .style = static_cast<int>(output),
                           .line = false});
    plot.caption.push_back(name + " is not drawn. " + found.words);
  }
  const bool any = std::any_of(plot.series.begin(), plot.series.end(),
                               [](const PlotSeries& series) { return !series.points.empty(); });
  if (any) {
    plot.triangles = {{1, "1"}, {2, "2"}};
    plot.caption.insert(
        plot.caption.begin(),
        "Error: distance from the extrapolated value. The slope of a line is the order. The finest three "
        "values lie on the line of the observed order, "
        "because the extrapolated value is made from them; coarser ones tell whether it holds.");
  }
  return plot;
}

LinePlot plot_of(const GridConvergence& study, const std::vector<std::size_t>& outputs, GridPlot what) {
  LinePlot plot = what == GridPlot::values ? values_plot(study, outputs) : errors_plot(study, outputs);
  if (!study.is_complete()) plot.caption.emplace_back("The study was stopped: what is drawn was finished.");
  return plot;
}

}  // namespace

LinePlot study_plot(const GridConvergence& study, GridPlot what) {
  std::vector<std::size_t> all(study.outputs.size());
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
  return plot_of(study, all, what);
}

LinePlot output_plot(const GridConvergence& study, std::size_t output, GridPlot what) {
  return plot_of(study, {output}, what);
}

}  // namespace cloth
