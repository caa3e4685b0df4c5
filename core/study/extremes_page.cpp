#include <fmt/format.h>

#include "io/machine.h"
#include "study/extremes_report.h"

namespace cloth {
namespace {

HtmlTable matrix_html(const ExtremesTable& table) {
  HtmlTable matrix;
  matrix.caption =
      "Every method on every case. Rest the pointer on a cell for its reason. An asterisk: ended early, its "
      "force evaluations used up.";
  matrix.columns.push_back({"case", Align::left});
  for (const std::string& method : table.methods) matrix.columns.push_back({method, Align::left});
  for (std::size_t c = 0; c < table.cases.size(); ++c) {
    HtmlRow row;
    row.cells.emplace_back(HtmlText(table.cases[c].name), Verdict::none, table.cases[c].what);
    for (std::size_t m = 0; m < table.methods.size(); ++m) {
      const ExtremeCell* cell = table.cell(c, m);
      row.cells.emplace_back(HtmlText(word_of(cell)), cell ? words_of(cell->status).verdict : Verdict::none,
                             cell ? cell->detail : "not run");
    }
    matrix.rows.push_back(std::move(row));
  }
  return matrix;
}

/// A row for each case with a cell that is not stable.
HtmlTable reasons_html(const ExtremesTable& table) {
  HtmlTable reasons;
  reasons.columns = {{"case"}, {"not stable"}, {"why"}};
  for (std::size_t c = 0; c < table.cases.size(); ++c) {
    std::string methods;
    for (const ExtremeCell* cell : not_stable(table, c))
      methods += (methods.empty() ? "" : ", ") + cell->method;
    if (!methods.empty())
      reasons.rows.push_back(
          {{HtmlText(table.cases[c].name), HtmlText(methods), HtmlText(table.cases[c].reading)}});
  }
  return reasons;
}

HtmlTable case_html(const ExtremesTable& table, std::size_t extreme) {
  HtmlTable rows;
  rows.columns = {{"method"},
                  {"status"},
                  {"step (s)", Align::right},
                  {"steps", Align::right},
                  {"largest strain", Align::right},
                  {"energy ratio", Align::right},
                  {"run time (s)", Align::right},
                  {"what happened"}};
  for (std::size_t m = 0; m < table.methods.size(); ++m) {
    const ExtremeCell* cell = table.cell(extreme, m);
    if (!cell) continue;
    const bool ran = cell->status != ExtremeStatus::refused;
    const auto number = [&](double value) { return ran ? html_number(value) : HtmlText(""); };
    rows.rows.push_back({{HtmlText(cell->method),
                          {HtmlText(name_of(cell->status)), words_of(cell->status).verdict},
                          number(cell->time_step),
                          HtmlText(std::to_string(cell->steps)),
                          number(cell->max_strain),
                          number(cell->energy_ratio),
                          number(cell->wall),
                          HtmlText(cell->detail)}});
  }
  return rows;
}

bool has_cells(const ExtremesTable& table, std::size_t extreme) {
  for (std::size_t m = 0; m < table.methods.size(); ++m)
    if (table.cell(extreme, m)) return true;
  return false;
}

void add_cases(HtmlPage& page, const ExtremesTable& table) {
  page.heading("The cases one by one");
  page.paragraph(
      "What was done, what it shows, and each method's numbers. Strain is the largest of structural and "
      "shear springs over the whole run; the energy ratio is "
      "kinetic and elastic energy at the end over the energy scale.");
  for (std::size_t c = 0; c < table.cases.size(); ++c) {
    const ExtremeCase& extreme = table.cases[c];
    if (!has_cells(table, c)) continue;
    const std::size_t red = not_stable(table, c).size();
    page.begin_details(HtmlText(extreme.name) +
                       (red == 0
                            ? HtmlText(" – all stable")
                            : HtmlText(fmt::format(" – {} of {} not stable", red, table.methods.size()))));
    page.paragraph(extreme.what + (extreme.reading.empty() ? "" : " " + extreme.reading));
    page.table(case_html(table, c));
    page.end_details();
  }
}

std::vector<std::pair<std::string, HtmlText>> conditions(const std::string& command) {
  std::vector<std::pair<std::string, HtmlText>> rows{{"command", html_code(command)}};
  rows.emplace_back("bounds",
                    HtmlText(fmt::format("each cell has a fixed number of steps (its case says how many) "
                                         "and at most {} force evaluations; nothing depends on time",
                                         ExtremeCase{}.max_evaluations)));
  rows.emplace_back("random starts", HtmlText(fmt::format("seed {}", extreme_seed)));
  for (const auto& [name, value] : fact_rows(machine_facts())) rows.emplace_back(name, HtmlText(value));
  return rows;
}

}  // namespace

std::string study_page(const ExtremesTable& table, const std::string& command, double) {
  HtmlPage page(
      "Stiff and extreme cases",
      fmt::format("{} methods on {} cases that break simulations. Every cell is a finite result or a "
                  "stop that names step, particle and cause.",
                  table.methods.size(), table.cases.size()));
  if (!table.is_complete())
    page.notice(fmt::format("Interrupted: {} of {} cells were run.", table.cells.size(),
                            table.cases.size() * table.methods.size()),
                Verdict::warn);
  page.heading("The table");
  page.paragraph(fmt::format("{} cells: {}.", table.cells.size(), count_of_statuses(table)));
  page.table(matrix_html(table));
  page.heading("The words");
  HtmlTable words;
  words.columns = {{"status"}, {"meaning"}};
  for (std::size_t k = 0; k < std::size(extreme_status_names); ++k) {
    const ExtremeWords& status = words_of(static_cast<ExtremeStatus>(k));
    words.rows.push_back({{{extreme_status_names[k], status.verdict}, status.meaning}});
  }
  page.table(words);
  page.paragraph(
      "The energy scale is the kinetic energy that the scene can give: its fall, its wind, and what the "
      "start "
      "holds. Divergence is judged against ten times this scale after every step, energy growth against a "
      "twentieth of it at some fifty records of a run.");
  page.heading("Why cells are not stable");
  page.paragraph(
      "By case; what happened in each cell, with step, particle and cause, is in the next section.");
  page.table(reasons_html(table));
  add_cases(page, table);
  page.heading("How it was run");
  page.facts(conditions(command));
  return page.to_html();
}

}  // namespace cloth
