// The table of extreme cases as text, Markdown, CSV rows and a report.
#pragma once

#include <string>
#include <vector>

#include "report/category_map.h"
#include "report/html_page.h"
#include "study/extremes.h"
#include "study/study_table.h"

namespace cloth {

/// "stable 31, diverged 9": the statuses that occur, in their order.
std::string count_of_statuses(const ExtremesTable& table);

/// The status in a narrow column, with an asterisk where the cell ended early; "-" for a cell that was not
/// run.
std::string word_of(const ExtremeCell* cell);

/// What is said of a status.
struct ExtremeWords {
  std::string brief;  ///< in a narrow column
  Verdict verdict;
  RunClass run_class;  ///< whose look it has on a map
  const char* meaning;
};
const ExtremeWords& words_of(ExtremeStatus status);

/// The cells of one case that are not stable, and why: a stop says itself that it is one.
std::vector<const ExtremeCell*> not_stable(const ExtremesTable& table, std::size_t extreme);
std::string reason_of(const ExtremeCell& cell);

/// case, method, status, detail, steps, max_strain, energy_ratio, wall_s, time_step_s, ended_early
CsvTable table_of(const ExtremesTable& table);
void visit_fields(CsvFields& fields, ExtremeCell& cell);

/// Methods over cases, a cell for each that was run.
CategoryMap study_plot(const ExtremesTable& table);

/// A row of words for each case, then every cell that is not stable with its reason.
std::string study_text(const ExtremesTable& table);
std::string study_json(const ExtremesTable& table);
std::string extremes_markdown(const ExtremesTable& table);

/// report.html. `command` made it in `wall` s.
std::string study_page(const ExtremesTable& table, const std::string& command, double wall = 0);

}  // namespace cloth
