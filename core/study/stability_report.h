// A stability map on paper: CSV, SVG and a page that explains itself.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "report/heat_map.h"
#include "study/stability_map.h"
#include "study/study_table.h"

namespace cloth {

/// Whether a limit is a number that a chart or a ratio can show.
inline bool finite_positive(double limit) {
  return std::isfinite(limit) && limit > 0;
}

/// What a cell is called in stability.csv: "accurate", "stable-inaccurate", "energy-growth", "diverged",
/// "solver-failed"; "refused" without a step to run with, "not-run" after a stop.
std::string status_of(const StabilityCell& cell);

/// method,x,y,status,energy_ratio,predicted_limit_s,guaranteed_limit_s,provot_s,spectrum_limit_s,time_step_s,
/// growth_rate_per_s,steps,detail,wanted_steps; a row for each cell, method after method, from the lowest y.
CsvTable table_of(const StabilityMap& map);
void visit_fields(CsvFields& fields, StabilityCell& cell, const std::string& method);

std::size_t count_of(const MethodMap& method, RunClass run_class);

/// As the option says it: "springs.structural=10:1000:12:log".
std::string axis_text(const StudyAxis& axis);

/// The criterion in sentences, with its thresholds and what was done to the scene.
std::vector<std::string> criterion_text(const StabilityMap& map);

HeatMap study_plot(const StabilityMap& map);

/// measured / predicted of the bracketed limit that is farthest from its prediction; 0 where there is none.
double largest_deviation(const MethodMap& method);

/// report.html. `command` is what made it in `wall` s.
std::string study_page(const StabilityMap& map, const std::string& command, double wall);

/// For a terminal: a line for each method.
std::string study_text(const StabilityMap& map);
std::string study_json(const StabilityMap& map);

}  // namespace cloth
