// A study of error against run time as pictures, as one page, as tables and in words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/line_plot.h"
#include "study/study_table.h"
#include "study/work_precision.h"

namespace cloth {

enum class PlotAgainst { run_time, step, force_evaluations };

/// Errors of every run that reached the horizon; failed and refused runs in the row above, with their cause.
LinePlot study_plot(const WorkPrecision& study, PlotAgainst against = PlotAgainst::run_time);

/// report.html. `command` is what made it in `wall` s.
std::string study_page(const WorkPrecision& study, const std::string& command, double wall = 0);

/// work_precision.csv: a row for each run, failed and refused ones too.
CsvTable table_of(const WorkPrecision& study);
void visit_fields(CsvFields& fields, WorkPrecisionRun& run, const WorkPrecision& study,
                  const MethodStudy& method);

/// work_precision_samples.csv: a row for each timed repeat.
CsvTable sample_table(const WorkPrecision& study);
void visit_fields(CsvFields& fields, TimedSample& sample, const MethodStudy& method,
                  const WorkPrecisionRun& run);

/// One object: what was studied and measured, the order of each method, the machine.
std::string study_json(const WorkPrecision& study);

/// What an error costs with one method.
struct ErrorCost {
  double seconds = 0;
  double time_step = 0;       ///< s
  bool at_first_run = false;  ///< the longest step is more accurate than asked: no shorter time was measured
};

/// Along the line of the runs that reached the horizon, interpolated in logarithms; nullopt outside what was
/// measured. `error` is the RMS position error in m.
std::optional<ErrorCost> cost_of(const MethodStudy& method, double error);

/// 1e-2 to 1e-8 m.
const std::vector<double>& wanted_errors();

/// The index of the cheapest method for an error; nullopt where no measured run reaches it.
std::optional<std::size_t> cheapest(const WorkPrecision& study, double error);

/// For a terminal: a line for each method and what is cheapest.
std::string study_text(const WorkPrecision& study);

}  // namespace cloth
