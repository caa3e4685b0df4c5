// The validation as tables, as pictures and as one page.
#pragma once

#include <string>
#include <vector>

#include "io/file_digest.h"
#include "report/line_plot.h"
#include "study/validation/validation.h"

namespace cloth {

/// A line for each row: exact value, error on each grid, order, and whether what is promised holds.
std::string validation_text(const std::vector<ValidationRow>& rows);

/// A line for each row and grid.
std::string validation_csv(const std::vector<ValidationRow>& rows);
/// `files`: of the folder in which it is the index.
std::string validation_json(const std::vector<ValidationRow>& rows,
                            const std::vector<FileDigest>& files = {});

/// arc, x and y of an exact curve, in the strip's length.
std::string curve_csv(const StripCurve& curve);

/// The exact curve as a line and what was found with 20 cells as points.
LinePlot curve_plot(const ValidationRow& row);
/// The error of every row of a protocol against the cells.
LinePlot error_plot(const std::string& protocol, const std::vector<ValidationRow>& rows);

/// report.html. `command` is what made it in `wall` s.
std::string validation_page(const std::vector<ValidationRow>& rows, const std::string& command, double wall);

}  // namespace cloth
