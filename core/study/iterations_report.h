// A study of iterations as pictures, as one page, as a table and in words.
#pragma once

#include <string>
#include <vector>

#include "io/csv.h"
#include "report/line_plot.h"
#include "study/iterations.h"

namespace cloth {

/// The relative objective, on logarithmic axes.
enum class IterationsAgainst { iterations, time };
inline constexpr const char* iterations_time_name = "iterations_time.svg";
LinePlot study_plot(const IterationsStudy& study, IterationsAgainst against = IterationsAgainst::iterations);

/// report.html. `command` is what made it in `wall` s.
std::string study_page(const IterationsStudy& study, const std::string& command, double wall = 0);

/// "Newton's method", "XPBD"
std::string title_of_iterated(const std::string& method);

/// iterations.csv: a row for each method and number of iterations, the last of a method with what ended it.
CsvTable table_of(const IterationsStudy& study);
/// The row of one step of a method.
std::vector<std::string> line_of(const MethodIterations& method, std::size_t step);

/// For a terminal: what each method takes to some objectives, and what is to be said of the measurement.
std::string study_text(const IterationsStudy& study);
std::string study_json(const IterationsStudy& study);

}  // namespace cloth
