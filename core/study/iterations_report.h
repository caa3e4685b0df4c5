// A study of iterations as pictures, as one page, as a table and in words.
#pragma once

#include <string>
#include <vector>

#include "io/csv.h"
#include "io/file_digest.h"
#include "report/line_plot.h"
#include "study/iterations.h"

namespace cloth {

/// The relative objective, on logarithmic axes.
enum class IterationsAgainst { iterations, time };
LinePlot study_plot(const IterationsStudy& study, IterationsAgainst against);

/// report.html. `command` is what made it in `wall` s.
std::string study_page(const IterationsStudy& study, const std::string& command, double wall = 0);

/// iterations.csv: a row for each method and number of iterations.
CsvTable table_of(const IterationsStudy& study);

/// For a terminal: what each method takes to some objectives, and what is to be said of the measurement.
std::string study_text(const IterationsStudy& study);
std::string study_json(const IterationsStudy& study);

/// iterations.json: the same with what made it and the other files of its folder.
std::string study_index(const IterationsStudy& study, const std::string& command, double wall,
                        const std::vector<FileDigest>& files);

}  // namespace cloth
