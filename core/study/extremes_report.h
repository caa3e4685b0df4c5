// The table of extreme cases as text, Markdown, CSV rows and a report.
#pragma once

#include <string>
#include <vector>

#include "report/category_map.h"
#include "study/extremes.h"

namespace cloth {

/// "stable 31, diverged 9": the statuses that occur, in their order.
std::string count_of_statuses(const ExtremesTable& table);

/// case, method, status, detail, steps, max_strain, energy_ratio, wall_s, time_step_s, ended_early
std::vector<std::string> extremes_columns();
std::vector<std::string> extremes_row(const ExtremeCell& cell);

/// Methods over cases, a cell for each that was run.
CategoryMap extremes_map(const ExtremesTable& table);

/// A row of words for each case, then every cell that is not stable with its reason.
std::string extremes_text(const ExtremesTable& table);
std::string extremes_json(const ExtremesTable& table);
std::string extremes_markdown(const ExtremesTable& table);

/// report.html. `command` made it.
std::string extremes_html(const ExtremesTable& table, const std::string& command);

}  // namespace cloth
