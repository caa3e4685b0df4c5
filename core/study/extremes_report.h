// The table of extreme cases as text, Markdown, CSV rows and a report.
#pragma once

#include <string>
#include <vector>

#include "study/extremes.h"

namespace cloth {

/// Case after case, each with every method; an interrupted run has fewer cells.
struct ExtremesTable {
  std::vector<ExtremeCase> cases;
  std::vector<std::string> methods;
  std::vector<ExtremeCell> cells;

  /// Null where it was not run.
  const ExtremeCell* cell(std::size_t extreme, std::size_t method) const;
  bool is_complete() const { return cells.size() == cases.size() * methods.size(); }
};

/// "stable 31, diverged 9": the statuses that occur, in their order.
std::string count_of_statuses(const ExtremesTable& table);

/// case, method, status, detail, steps, max_strain, energy_ratio, wall_s
std::vector<std::string> extremes_columns();
std::vector<std::string> extremes_row(const ExtremeCell& cell);

/// A row of words for each case, then every cell that is not stable with its reason.
std::string extremes_text(const ExtremesTable& table);
std::string extremes_markdown(const ExtremesTable& table);

/// report.html. `command` made it.
std::string extremes_html(const ExtremesTable& table, const std::string& command);

}  // namespace cloth
