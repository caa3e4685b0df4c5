// What a sweep's results look like. One parameter: a curve of each output. Two in a grid: a map of each
// output with contours, failed points hatched. Plots of other sweeps: sweep_account.h.
#pragma once

#include "report/heat_map.h"
#include "report/line_plot.h"
#include "sweep/sweep_results.h"

namespace cloth {

/// The one number that a value is on an axis; nothing where it is a word or a vector.
std::optional<double> number_of(const ParameterValue& value);

/// Whether the plan varies one axis of numbers, whatever else moves with it.
bool has_curves(const SweepPlan& plan);
/// Whether it is a grid over two axes of numbers.
bool has_maps(const SweepPlan& plan);

LinePlot curve_plot(const SweepFolder& folder, const SweepResults& results, std::size_t output);
HeatMap output_map(const SweepFolder& folder, const SweepResults& results, std::size_t output);

struct SweepPlot {
  std::string name{};  ///< of its file: "sweep-peak.svg"
  std::string svg{};
  std::string caption{};
};
std::vector<SweepPlot> sweep_plots(const SweepFolder& folder, const SweepResults& results);

/// report.html
std::string sweep_page(const SweepFolder& folder, const SweepResults& results,
                       const std::vector<SweepPlot>& plots);

}  // namespace cloth
