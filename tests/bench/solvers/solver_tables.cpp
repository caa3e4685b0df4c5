#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bench/solvers/solver_study.h"
#include "bench/speed/bench_page.h"

namespace cloth::solvers {
namespace {

using json = nlohmann::ordered_json;
using speed::number;
using speed::Page;
using speed::Spread;

std::string cell(const Spread& spread) {
  return spread.median > 0 ? number(spread.median) : "";
}

TextTable solver_table(const SolverTable& system) {
  TextTable table;
  table.columns = {{"Solver"},
                   {"Iterations", true},
                   {"Residual", true},
                   {"Analysis (ms)", true},
                   {"Conversion (ms)", true},
                   {"Set-up (ms)", true},
                   {"Solve (ms)", true},
                   {"Set-up + solve", true},
                   {"/ ours", true},
                   {"Remark"}};
  const SolverRow* best = system.best_of_ours();
  for (const SolverRow& row : system.rows) {
    if (!row.failure.empty()) {
      table.rows.push_back({row.name, "", "", "", "", "", "", "-", "", row.failure});
      continue;
    }
    table.rows.push_back({row.name, row.iterations > 0 ? std::to_string(row.iterations) : "",
                          fmt::format("{:.1e}", row.residual), cell(row.analysis), cell(row.conversion),
                          cell(row.set_up), cell(row.solve), number(row.whole()),
                          best ? number(row.whole() / best->whole()) : "", ""});
  }
  return table;
}

std::vector<std::string> libraries_of(const SolverReport& report) {
  std::vector<std::string> names;
  for (const SolverTable& table : report.tables)
    for (const SolverRow& row : table.rows)
      if (!row.is_ours() && std::find(names.begin(), names.end(), row.library) == names.end())
        names.push_back(row.library);
  return names;
}

json spread_json(const Spread& spread) {
  if (!(spread.median > 0)) return {};
  return {{"median", spread.median}, {"low", spread.low}, {"high", spread.high}, {"least", spread.least}};
}

json row_json(const SolverRow& row, const SolverRow* best) {
  const bool failed = !row.failure.empty();
  return {{"solver", row.name},
          {"library", row.is_ours() ? json() : json(row.library)},
          {"iterations", row.iterations},
          {"relative_residual", failed ? json() : json(row.residual)},
          {"analysis_ms", spread_json(row.analysis)},
          {"conversion_ms", spread_json(row.conversion)},
          {"set_up_ms", spread_json(row.set_up)},
          {"solve_ms", spread_json(row.solve)},
          {"ratio_to_best_of_ours", best && !failed ? json(row.whole() / best->whole()) : json()},
          {"failure", failed ? json(row.failure) : json()}};
}

}  // namespace

std::string solver_head(const SolverReport& report, bool markdown) {
  Page page(markdown);
  const MachineFacts& machine = report.machine;
  page.paragraph(fmt::format("Clothlab {}, {}, {}; {}, {} cores{}{}", machine.version, machine.compiler,
                             machine.build_type, machine.processor, machine.cores,
                             libraries_of(report).empty() ? "" : "; ",
                             fmt::join(libraries_of(report), "; ")));
  page.paragraph(fmt::format(
      "Linear systems of Newton's method in a step of implicit Euler (1/60 s, 1000 N/m), each solved to a "
      "relative residual of {:.0e}. Processor time, one thread, medians of rounds in turns. Analysis: once "
      "for a "
      "pattern. Conversion: our blocks to the library's numbers; ours need none, and it is not part of the "
      "ratio. "
      "/ ours: to the cheapest of ours.",
      report.residual));
  if (!report.missing.empty())
    page.paragraph(fmt::format("This program was built without {}.", fmt::join(report.missing, " and ")));
  std::string text = page.take();
  return markdown ? text.substr(1) : text;
}

std::string solver_text(const SolverTable& table, bool markdown) {
  Page page(markdown);
  page.heading(fmt::format("{0} x {0}, {1}", table.size, cloth_shape_names[static_cast<int>(table.shape)]));
  page.paragraph(fmt::format(
      "Iteration {} of Newton's method, {}, {} unknowns, {:.0f} % of the springs compressed.",
      table.iteration,
      table.is_exact ? "the exact Jacobian" : "clamped, since the exact Jacobian is not positive definite",
      table.unknowns, 100 * table.compressed_part));
  page.table(solver_table(table));
  return page.take();
}

std::string solver_text(const SolverReport& report, bool markdown) {
  std::string text = solver_head(report, markdown);
  for (const SolverTable& table : report.tables) text += solver_text(table, markdown);
  return text;
}

std::string solver_json(const SolverReport& report) {
  json object{{"clothlab", report.machine.version}, {"processor", report.machine.processor},
              {"libraries", libraries_of(report)},  {"missing", report.missing},
              {"complete", report.complete},        {"relative_residual", report.residual},
              {"repeats", report.repeats},          {"systems", json::array()}};
  for (const SolverTable& table : report.tables) {
    json one{{"size", table.size},
             {"shape", cloth_shape_names[static_cast<int>(table.shape)]},
             {"newton_iteration", table.iteration},
             {"exact", table.is_exact},
             {"unknowns", table.unknowns},
             {"compressed_part", table.compressed_part},
             {"solvers", json::array()}};
    for (const SolverRow& row : table.rows) one["solvers"].push_back(row_json(row, table.best_of_ours()));
    object["systems"].push_back(std::move(one));
  }
  return object.dump(2) + "\n";
}

}  // namespace cloth::solvers
