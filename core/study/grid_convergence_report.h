// A study of grid convergence as pictures, as one page, as tables and in words.
#pragma once

#include <string>
#include <vector>

#include "report/line_plot.h"
#include "study/grid_convergence.h"
#include "study/study_table.h"

namespace cloth {

enum class GridPlot { values, errors };
inline constexpr const char* grid_errors_name = "convergence_error.svg";

/// Values: outputs against the length of a cell, with what they extrapolate to; of several outputs each over
/// that. Errors: what each value differs from it by, on logarithmic axes; an output without an order stands in
/// the legend alone.
LinePlot study_plot(const GridConvergence& study, GridPlot what = GridPlot::values);

/// The same of one output, in its unit.
LinePlot output_plot(const GridConvergence& study, std::size_t output, GridPlot what);

/// report.html. `command` is what made it in `wall` s.
std::string study_page(const GridConvergence& study, const std::string& command, double wall = 0);

/// convergence.csv: a row for each grid, failed and refused ones too. After what names and tells the run,
/// each output has five columns: its value, its difference from that of the grid before, and the observed
/// order, extrapolated value and grid convergence index of the grids so far.
CsvTable table_of(const GridConvergence& study);
void visit_fields(CsvFields& fields, GridRun& run, const GridConvergence& study);

/// What is said of one grid in a table of one output, each empty where there is nothing.
struct GridRow {
  std::string value{}, difference{}, order{}, extrapolate{}, index{};
};
GridRow row_of(const GridConvergence& study, std::size_t output, std::size_t run);

/// "lowest_point:max" as people say it: "lowest point, largest", with the unit "lowest point, largest (m)".
std::string name_of_output(const std::string& output);
std::string words_of_output(const std::string& output);

/// For a terminal: a table for each output and what follows from it.
std::string study_text(const GridConvergence& study);
std::string study_json(const GridConvergence& study);

}  // namespace cloth
