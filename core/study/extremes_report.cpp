#include "study/extremes_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "report/svg.h"
#include "report/text_table.h"

namespace cloth {
namespace {

/// "semi-", "implicit-", "euler"
std::vector<std::string> parts_of(const std::string& name) {
  std::vector<std::string> parts{""};
  for (const char c : name) {
    parts.back() += c;
    if (c == '-') parts.emplace_back();
  }
  return parts;
}

std::size_t case_width(const ExtremesTable& table) {
  std::size_t width = 4;
  for (const ExtremeCase& extreme : table.cases) width = std::max(width, extreme.name.size());
  return width;
}

std::string matrix_text(const ExtremesTable& table) {
  constexpr std::size_t word_width = 8;
  const std::size_t first = case_width(table);
  std::vector<std::vector<std::string>> headers;
  std::vector<std::size_t> widths;
  std::size_t lines = 1;
  for (const std::string& method : table.methods) {
    headers.push_back(parts_of(method));
    lines = std::max(lines, headers.back().size());
    std::size_t width = word_width;
    for (const std::string& part : headers.back()) width = std::max(width, part.size());
    widths.push_back(width);
  }
  std::string text;
  const auto end_line = [&] {
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  };
  for (std::size_t line = 0; line < lines; ++line) {
    text += fmt::format("{:<{}}", line + 1 == lines ? "case" : "", first);
    for (std::size_t m = 0; m < headers.size(); ++m) {
      const std::size_t skipped = lines - headers[m].size();
      text += fmt::format("  {:<{}}", line < skipped ? "" : headers[m][line - skipped], widths[m]);
    }
    end_line();
  }
  for (std::size_t c = 0; c < table.cases.size(); ++c) {
    text += fmt::format("{:<{}}", table.cases[c].name, first);
    for (std::size_t m = 0; m < widths.size(); ++m)
      text += fmt::format("  {:<{}}", word_of(table.cell(c, m)), widths[m]);
    end_line();
  }
  return text;
}

constexpr const char* markdown_head = R"(# Stiff and extreme cases

`clothlab-cli extremes` runs every method on a fixed, named list of cases that break simulations. Every cell is a finite
result or a stop that names step, particle and cause; none hangs, and none goes on with values that are not finite. With
`--out DIR` the same table is a page with the numbers of every cell (`report.html`) and a file (`extremes.csv`). Its cells
are run on all cores (`--jobs`), and several machines share them by `--shard` ([how](../command-line.md#a-study-in-parts)).

The base scene has 9 x 9 particles of 10 g, 0.1 m apart, hung by two corners, structural springs of 100 N/m, shear of 50, flexion
of 10, viscous damping of 0.001 N s/m, gravity, steps of 2 ms. Most cases change one thing. A cell has a fixed number of steps,
between 50 and 2000, and at most 100 000 force evaluations; nothing depends on the clock, and random starts have a fixed seed
(19950517), so the table comes out the same again.

| word | meaning |
|---|---|
| stable | finite to the end, and no energy from nowhere; it does not say accurate: a method that damps everything is stable |
| **growth** | finite to the end, but in the second half of the run kinetic, elastic and gravity energy are in the mean above those of the start and all works, by more than 5 % of the energy scale; losses by damping are not counted against a method |
| **diverged** | stopped: a position or velocity was not finite, or the energy that the ledger leaves unexplained was ten times the energy scale |
| **failed** | stopped: the equations of an implicit step could not be solved |
| open | not converged: an iterative method left steps whose equations were not solved, so that the motion is another one; the residual is told |
| unreach. | the pins make the deformation rate unreachable; the run is finite, and the excess that is left is told |
| refused | the method has no stable step for the scene, so none was taken |

The energy scale is the kinetic energy that the scene can give: its fall, its wind, and what the start holds. Where positions start
beyond the deformation rate they are brought within it before the first step, without giving them a velocity.

This page is the output of `clothlab-cli extremes --markdown`. An asterisk: the cell ended early, its force evaluations used up.

## The table

)";

}  // namespace

const ExtremeWords& words_of(ExtremeStatus status) {
  using enum RunClass;
  static const std::array<ExtremeWords, std::size(extreme_status_names)> words{{
      {"stable", Verdict::good, accurate,
       "Finite to the end, and no energy appeared from nowhere. It does not say accurate: a method that "
       "damps everything is stable."},
      {"open", Verdict::warn, stable_but_inaccurate,
       "Finite, and no energy appeared from nowhere, but the last iteration of some step still changed more "
       "than a tenth of the largest speed: the step's equations were not solved, and the motion is another "
       "one, as a rule a slower one. The residual is told."},
      {"growth", Verdict::bad, energy_growth,
       "Finite to the end, but in the second half kinetic, elastic and gravity energy were in the mean above "
       "those of the start and all works, by more than 5 % of the energy scale: the method made energy, in "
       "one violent moment or steadily."},
      {"diverged", Verdict::bad, diverged,
       "Stopped: a position or velocity was not finite, or the energy that the ledger leaves unexplained was "
       "ten times all that the scene can give. The stop names step, particle and cause."},
      {"unreach.", Verdict::warn, stable_but_inaccurate,
       "The pins make the deformation rate unreachable, which their distance shows before the first step. "
       "The run is finite, with the excess that is left."},
      {"refused", Verdict::warn, stable_but_inaccurate,
       "No step is stable for this method and scene, so none was taken."},
      {"failed", Verdict::bad, solver_failed,
       "Stopped: the equations of an implicit step could not be solved. The stop names step, particle and "
       "cause."},
  }};
  return words[static_cast<std::size_t>(status)];
}

std::string word_of(const ExtremeCell* cell) {
  return cell ? words_of(cell->status).brief + (cell->ended_early ? "*" : "") : "-";
}

std::vector<const ExtremeCell*> not_stable(const ExtremesTable& table, std::size_t extreme) {
  std::vector<const ExtremeCell*> cells;
  for (std::size_t m = 0; m < table.methods.size(); ++m)
    if (const ExtremeCell* cell = table.cell(extreme, m); cell && cell->status != ExtremeStatus::stable)
      cells.push_back(cell);
  return cells;
}

std::string reason_of(const ExtremeCell& cell) {
  return cell.status == ExtremeStatus::diverged ? cell.detail
                                                : fmt::format("{}: {}", name_of(cell.status), cell.detail);
}

std::string count_of_statuses(const ExtremesTable& table) {
  std::string text;
  for (std::size_t k = 0; k < std::size(extreme_status_names); ++k) {
    const auto status = static_cast<ExtremeStatus>(k);
    const auto count = std::count_if(table.cells.begin(), table.cells.end(),
                                     [&](const ExtremeCell& cell) { return cell.status == status; });
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name_of(status), count);
  }
  return text;
}

void visit_fields(CsvFields& fields, ExtremeCell& cell) {
  fields.text("case", cell.case_name);
  fields.text("method", cell.method);
  fields.status(cell.status, extreme_status_names);
  fields.text("detail", cell.detail);
  fields.whole("steps", cell.steps);
  fields.number("max_strain", cell.max_strain);
  fields.number("energy_ratio", cell.energy_ratio);
  fields.number("wall_s", cell.wall);
  fields.number("time_step_s", cell.time_step);
  fields.whole("ended_early", cell.ended_early);
}

CategoryMap study_plot(const ExtremesTable& table) {
  std::vector<ClassStyle> classes;
  for (std::size_t k = 0; k < std::size(extreme_status_names); ++k) {
    const auto status = static_cast<ExtremeStatus>(k);
    ClassStyle& style =
        classes.emplace_back(run_classes()[static_cast<std::size_t>(words_of(status).run_class)]);
    style.name = name_of(status);
    if (status == ExtremeStatus::refused) style.colour = page_colours().band, style.mark = CellMark::slash;
  }
  CategoryMap map{.title = "Stiff and extreme cases"};
  map.subtitle = table.scene ? table.scene->title : "the fixed list, 9 x 9 particles";
  map.classes = std::move(classes);
  for (const ExtremeCase& extreme : table.cases) map.columns.push_back(extreme.name);
  for (const std::string& method : table.methods) map.rows.push_back(method);
  map.cells.resize(map.rows.size() * map.columns.size());
  for (std::size_t c = 0; c < table.cases.size(); ++c)
    for (std::size_t m = 0; m < table.methods.size(); ++m)
      if (const ExtremeCell* cell = table.cell(c, m)) {
        const std::string note = cell->detail + (cell->detail.empty() ? "" : "\n") +
                                 fmt::format("step {:.4g} s, {} steps, {:.2g} s of run time", cell->time_step,
                                             cell->steps, cell->wall);
        map.cells[m * table.cases.size() + c] = {static_cast<int>(cell->status), note,
                                                 static_cast<int>(c * table.methods.size() + m)};
      }
  return map;
}

CsvTable table_of(const ExtremesTable& table) {
  CsvTable rows{written(ExtremeCell{}).names, {}};
  for (const ExtremeCell& cell : table.cells) rows.rows.push_back(written(cell).texts);
  return rows;
}

std::string study_text(const ExtremesTable& table) {
  std::string text = matrix_text(table) + "\n";
  bool any = false;
  for (const ExtremeCell& cell : table.cells) {
    if (cell.status == ExtremeStatus::stable) continue;
    text += fmt::format("{}{}, {}: {}\n", any ? "" : "Not stable:\n", cell.case_name, cell.method,
                        reason_of(cell));
    any = true;
  }
  if (std::any_of(table.cells.begin(), table.cells.end(),
                  [](const ExtremeCell& cell) { return cell.ended_early; }))
    text += fmt::format("{}* ended early, its {} force evaluations used up\n", any ? "\n" : "",
                        ExtremeCase{}.max_evaluations);
  return text + fmt::format("{}{} cells: {}; seed of random starts {}\n", any ? "\n" : "", table.cells.size(),
                            count_of_statuses(table), extreme_seed);
}

std::string study_json(const ExtremesTable& table) {
  using json = nlohmann::ordered_json;
  json root{{"complete", table.is_complete()},
            {"seed", extreme_seed},
            {"cases", json::array()},
            {"methods", table.methods},
            {"cells", json::array()}};
  for (const ExtremeCase& extreme : table.cases)
    root["cases"].push_back({{"name", extreme.name}, {"what", extreme.what}});
  for (const ExtremeCell& cell : table.cells)
    root["cells"].push_back({{"case", cell.case_name},
                             {"method", cell.method},
                             {"status", name_of(cell.status)},
                             {"detail", cell.detail},
                             {"time_step_s", cell.time_step},
                             {"steps", cell.steps},
                             {"max_strain", cell.max_strain},
                             {"energy_ratio", cell.energy_ratio},
                             {"wall_s", cell.wall}});
  return root.dump(2) + "\n";
}

std::string extremes_markdown(const ExtremesTable& table) {
  TextTable matrix{{{"case"}}, {}};
  for (const std::string& method : table.methods) matrix.columns.push_back({method});
  for (std::size_t c = 0; c < table.cases.size(); ++c) {
    std::vector<std::string>& row = matrix.rows.emplace_back(1, table.cases[c].name);
    for (std::size_t m = 0; m < table.methods.size(); ++m) {
      const ExtremeCell* cell = table.cell(c, m);
      const bool red = cell && words_of(cell->status).verdict == Verdict::bad;
      row.push_back(red ? "**" + word_of(cell) + "**" : word_of(cell));
    }
  }
  std::string text = markdown_head + to_markdown(matrix);
  text += fmt::format("\n{} cells: {}.\n", table.cells.size(), count_of_statuses(table));
  for (std::size_t c = 0; c < table.cases.size(); ++c) {
    if (not_stable(table, c).empty()) continue;
    const ExtremeCase& extreme = table.cases[c];
    text += fmt::format("\n### {}\n\n{}{}{}\n\n", extreme.name, extreme.what,
                        extreme.reading.empty() ? "" : " ", extreme.reading);
    for (const ExtremeCell* cell : not_stable(table, c))
      text += fmt::format("- `{}`: {}\n", cell->method, reason_of(*cell));
  }
  return text;
}

}  // namespace cloth
