#include "study/extremes_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "io/csv.h"
#include "report/svg.h"

namespace cloth {
namespace {

/// A status in a narrow column.
std::string status_word(const ExtremeCell* cell) {
  if (!cell) return "-";
  switch (cell->status) {
    case ExtremeStatus::not_converged:
      return "open";
    case ExtremeStatus::energy_growth:
      return "growth";
    case ExtremeStatus::solver_failed:
      return "failed";
    case ExtremeStatus::unreachable:
      return "unreach.";
    default:
      return name_of(cell->status);
  }
}

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
`--out DIR` the same table is a page with the numbers of every cell (`report.html`) and a file (`extremes.csv`).

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

std::string word_of(const ExtremeCell* cell) {
  return status_word(cell) + (cell && cell->ended_early ? "*" : "");
}

Verdict verdict_of(ExtremeStatus status) {
  switch (status) {
    case ExtremeStatus::stable:
      return Verdict::good;
    case ExtremeStatus::not_converged:
    case ExtremeStatus::unreachable:
    case ExtremeStatus::refused:
      return Verdict::warn;
    default:
      return Verdict::bad;
  }
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
  for (const ExtremeStatus status : extreme_statuses()) {
    const auto count = std::count_if(table.cells.begin(), table.cells.end(),
                                     [&](const ExtremeCell& cell) { return cell.status == status; });
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name_of(status), count);
  }
  return text;
}

std::vector<std::string> extremes_columns() {
  return {"case",       "method",       "status", "detail",      "steps",
          "max_strain", "energy_ratio", "wall_s", "time_step_s", "ended_early"};
}

std::vector<std::string> extremes_row(const ExtremeCell& cell) {
  return {cell.case_name,
          cell.method,
          name_of(cell.status),
          cell.detail,
          std::to_string(cell.steps),
          csv_number(cell.max_strain),
          csv_number(cell.energy_ratio),
          csv_number(cell.wall),
          csv_number(cell.time_step),
          cell.ended_early ? "1" : "0"};
}

CategoryMap extremes_map(const ExtremesTable& table) {
  static const std::vector<ClassStyle> classes = [] {
    const auto& runs = run_classes();
    const auto look = [&](RunClass run_class) { return runs[static_cast<std::size_t>(run_class)]; };
    std::vector<ClassStyle> styles;
    for (const ExtremeStatus status : extreme_statuses()) {
      ClassStyle style = look(status == ExtremeStatus::stable          ? RunClass::accurate
                              : status == ExtremeStatus::energy_growth ? RunClass::energy_growth
                              : status == ExtremeStatus::diverged      ? RunClass::diverged
                              : status == ExtremeStatus::solver_failed ? RunClass::solver_failed
                                                                       : RunClass::stable_but_inaccurate);
      style.name = name_of(status);
      if (status == ExtremeStatus::refused) style.colour = page_colours().band, style.mark = CellMark::slash;
      styles.push_back(std::move(style));
    }
    return styles;
  }();
  CategoryMap map{.title = "Stiff and extreme cases"};
  map.subtitle = table.scene ? table.scene->title : "the fixed list, 9 x 9 particles";
  map.classes = classes;
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

CsvTable extremes_table(const ExtremesTable& table) {
  CsvTable rows{extremes_columns(), {}};
  for (const ExtremeCell& cell : table.cells) rows.rows.push_back(extremes_row(cell));
  return rows;
}

std::string extremes_text(const ExtremesTable& table) {
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
                        ExtremeCase{}.most_evaluations);
  return text + fmt::format("{}{} cells: {}; seed of random starts {}\n", any ? "\n" : "", table.cells.size(),
                            count_of_statuses(table), extreme_seed);
}

std::string extremes_json(const ExtremesTable& table) {
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
  std::string text = std::string(markdown_head) + "| case |";
  for (const std::string& method : table.methods) text += " " + method + " |";
  text += "\n|---|";
  for (std::size_t m = 0; m < table.methods.size(); ++m) text += "---|";
  for (std::size_t c = 0; c < table.cases.size(); ++c) {
    text += fmt::format("\n| {} |", table.cases[c].name);
    for (std::size_t m = 0; m < table.methods.size(); ++m) {
      const ExtremeCell* cell = table.cell(c, m);
      const bool red = cell && verdict_of(cell->status) == Verdict::bad;
      text += red ? fmt::format(" **{}** |", word_of(cell)) : fmt::format(" {} |", word_of(cell));
    }
  }
  text += fmt::format("\n\n{} cells: {}.\n", table.cells.size(), count_of_statuses(table));
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
