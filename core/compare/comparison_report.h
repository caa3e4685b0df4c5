// A comparison that was run, as text, as data, as pictures and as one page.
#pragma once

#include <string>

#include "compare/run_comparison.h"
#include "report/line_plot.h"

namespace cloth {

/// The ranked table for a terminal, and why panes stopped.
std::string comparison_text(const ComparisonRun& run);

/// summary.json
std::string comparison_summary(const ComparisonRun& run);

/// Over time, a curve for each pane in its colour and marker; the differences on a logarithmic axis. Panes
/// that stopped are marked in the row above, with their cause.
LinePlot difference_plot(const ComparisonRun& run);
LinePlot energy_error_plot(const ComparisonRun& run);
LinePlot strain_plot(const ComparisonRun& run);

/// What compare.svg shows: the differences, or the strains where there is no reference.
LinePlot main_plot(const ComparisonRun& run);

/// report.html. `command` is what made it.
std::string comparison_page(const ComparisonRun& run, const std::string& command);

}  // namespace cloth
