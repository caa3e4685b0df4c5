// The validation as tables, as pictures and as one page.
#pragma once

#include <string>
#include <vector>

#include "io/csv.h"
#include "report/line_plot.h"
#include "study/validation/validation.h"

namespace cloth {

/// A line for each row: exact value, error on each grid, order, and whether what is promised holds.
std::string validation_text(const std::vector<ValidationRow>& rows);

std::string validation_json(const std::vector<ValidationRow>& rows);

/// validation.csv: a line for each row and grid; of a row that failed at once a line without a grid.
CsvTable table_of(const ValidationStudy& study);
std::vector<std::vector<std::string>> lines_of(const ValidationRow& row);

/// validation_points.csv: the points that were found with 20 cells, in the strip's length.
inline constexpr const char* validation_points_name = "validation_points.csv";
CsvTable points_table(const ValidationStudy& study);
std::vector<std::vector<std::string>> point_lines(const ValidationRow& row);

/// arc, x and y of an exact curve, in the strip's length.
std::string curve_csv(const StripCurve& curve);

/// The exact curve as a line and what was found with 20 cells as points.
LinePlot curve_plot(const ValidationRow& row);
/// The error of every row of a protocol against the cells.
LinePlot error_plot(const std::string& protocol, const std::vector<ValidationRow>& rows);

/// The diagrams of a study, each with a name: all protocols, then of each its errors and its curves.
std::vector<std::string> diagram_names(const ValidationStudy& study);
LinePlot study_plot(const ValidationStudy& study, std::size_t which = 0);

std::string study_page(const ValidationStudy& study, const std::string& command, double wall);
std::string study_text(const ValidationStudy& study);
std::string study_json(const ValidationStudy& study);

/// report.html. `command` is what made it in `wall` s.
std::string validation_page(const std::vector<ValidationRow>& rows, const std::string& command, double wall);

}  // namespace cloth
