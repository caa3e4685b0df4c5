// A study of error against run time as pictures and as one page.
#pragma once

#include <string>

#include "report/line_plot.h"
#include "study/work_precision.h"

namespace cloth {

enum class PlotAgainst { run_time, step, force_evaluations };

/// Errors of every run that reached the horizon; failed and refused runs in the row above, with their cause.
LinePlot error_plot(const WorkPrecision& study, PlotAgainst against);

/// report.html. `command` is what made it.
std::string work_precision_page(const WorkPrecision& study, const std::string& command);

}  // namespace cloth
