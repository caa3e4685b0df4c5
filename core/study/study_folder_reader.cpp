#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "cloth/cut_grid.h"
#include "cloth/mesh_cloth.h"
#include "contact/start_check.h"
#include "integrators/registry.h"
#include "io/json_locator.h"
#include "io/json_syntax.h"
#include "io/text_file.h"
#include "scene/scene_checks.h"
#include "scene/scene_json.h"
#include "study/extremes_report.h"
#include "study/grid_convergence_report.h"
#include "study/stability_report.h"
#include "study/study_index.h"
#include "study/validation/validation_report.h"
#include "study/work_precision_report.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

double number_or(const JsonEntry& value, double otherwise) {
  return value.is_null() ? otherwise : value.number();
}

std::vector<std::string> methods_of(const JsonEntry& options) {
  const auto& known = integrator_names();
  const JsonEntry methods = options.at("methods");
  for (const JsonEntry& method : methods.entries())
    if (std::find(known.begin(), known.end(), method.text()) == known.end())
      throw method.bad("is not a method");
  if (methods.entries().empty()) throw methods.bad("must not be empty");
  return methods.texts();
}

Scene read_scene_of(const JsonEntry& root, const std::filesystem::path& folder) {
  const MeshSource meshes{.folder = SceneFolder{.path = folder.string()}};
  SceneReading reading =
      read_runnable_scene(root.at("scene").value().dump(), "study.json, scene", {}, meshes);
  if (!reading.scene) throw BadFolder{reading.problems.front().text()};
  return std::move(*reading.scene);
}

/// What names a run in both tables.
std::string key_of(const Rows& rows, std::size_t row) {
  return rows.text(row, "method") + "|" + rows.text(row, "time_step") + "|" + rows.text(row, "steps") + "|" +
         rows.text(row, "tolerance");
}

WorkPrecision read_work_precision(const std::filesystem::path& folder, const JsonEntry& root) {
  WorkPrecision study;
  study.scene = read_scene_of(root, folder);
  study.particles = particle_count(study.scene.cloth);
  study.diagonal = diagonal_of(study.scene.cloth);
  study.steps_per_method = WorkPrecisionOptions{}.steps_per_method;  // that old versions took
  const JsonEntry& options = root.at("options");
  visit_options(JsonFields(options), study);
  const auto methods = methods_of(options);
  if (const auto rule = broken_horizon_rule(study.scene, methods, study.horizon))
    throw options.at("horizon_s").bad(*rule);
  study.estimated = root.at("estimated_s").number();
  study.stopped = !root.at("complete").flag();
  if (root.has("parts")) study.parts = root.at("parts").whole<int>(0, 1e9);
  visit_reference(JsonFields(root.at("reference")), study.reference);
  Ladders ladders = make_ladders(study.scene, methods, study.horizon);
  study.horizon = ladders.horizon;
  study.samples = ladders.samples;
  for (StepLadder& ladder : ladders.methods)
    study.methods.push_back({.ladder = std::move(ladder), .runs = {}, .order = {}, .velocity_order = {}});

  const Rows rows(folder, "work_precision.csv", root);
  std::map<std::string, std::pair<std::size_t, std::size_t>> places;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::string method = rows.text(row, "method");
    const auto at = std::find_if(study.methods.begin(), study.methods.end(),
                                 [&](const MethodStudy& known) { return known.ladder.facts.name == method; });
    if (at == study.methods.end()) throw rows.bad(row, "method", method, "is not in study.json");
    places[key_of(rows, row)] = {static_cast<std::size_t>(at - study.methods.begin()), at->runs.size()};
    read_row(rows, row, at->runs.emplace_back(), study, *at);
  }
  const Rows samples(folder, "work_precision_samples.csv", root);
  for (std::size_t row = 0; row < samples.size(); ++row) {
    const auto at = places.find(key_of(samples, row));
    if (at == places.end()) throw samples.bad(row, "method", samples.text(row, "method"), "has no such run");
    MethodStudy& method = study.methods[at->second.first];
    WorkPrecisionRun& run = method.runs[at->second.second];
    read_row(samples, row, run.samples.emplace_back(), method, run);
  }
  conclude(study);
  return study;
}

/// The same rules as on the command line.
void check_axis(const StudyAxis& axis) {
  const auto checked = parse_axis(axis_text(axis), "study.json, axis");
  if (const auto* problem = std::get_if<Problem>(&checked)) throw BadFolder{problem->text()};
}

/// The place of a value on an axis, which another version may have rounded elsewhere; nullopt: it has none.
std::optional<std::size_t> place_on(const std::vector<double>& values, double value) {
  auto at = std::lower_bound(values.begin(), values.end(), value);
  if (at == values.end() || (at != values.begin() && value - at[-1] < *at - value)) --at;
  if (!std::isfinite(value) || std::abs(*at - value) > 1e-9 * std::abs(value)) return std::nullopt;
  return static_cast<std::size_t>(at - values.begin());
}

/// Cells that are missing before the one of the row are there, not run.
void read_cell(const Rows& rows, std::size_t row, const StabilityMap& map, MethodMap& method) {
  StabilityCell cell;
  read_row(rows, row, cell, method.method);
  const auto ix = place_on(map.x_values, cell.x), iy = place_on(map.y_values, cell.y);
  if (!ix || !iy) throw rows.bad(row, ix ? "y" : "x", csv_number(ix ? cell.y : cell.x), "is not on its axis");
  const std::size_t columns = map.x_values.size(), place = *iy * columns + *ix;
  for (std::size_t k = method.cells.size(); k <= place; ++k)
    method.cells.push_back({.x = map.x_values[k % columns], .y = map.y_values[k / columns]});
  if (method.cells[place].status != CellStatus::not_run)
    throw rows.bad(row, "x", csv_number(cell.x), "and this y are there already");
  method.cells[place] = std::move(cell);
}

/// None where the line's last cell is not there: a study that goes on writes study.json before its table, so
/// that who reads meanwhile may find limits of cells to come. Whoever goes on measures them anew.
std::optional<MeasuredLimit> read_limit(const JsonEntry& value, const StabilityMap& map,
                                        const MethodMap& method) {
  const bool x_is_step = map.options.x.path == time_step_path;
  const std::size_t columns = map.x_values.size(), rows = map.y_values.size();
  MeasuredLimit limit{.other = value.at("at").number(),
                      .longest_stable = value.at("longest_stable_s").number(),
                      .shortest_unstable = number_or(value.at("shortest_unstable_s"), infinity),
                      .stable_beyond = value.at("stable_beyond").flag()};
  const std::vector<double>& others = x_is_step ? map.y_values : map.x_values;
  const auto place = place_on(others, limit.other);
  if (!place) throw value.at("at").bad("is not on its axis");
  limit.other = others[*place];
  const std::size_t cell = x_is_step ? *place * columns + columns - 1 : (rows - 1) * columns + *place;
  if (cell >= method.cells.size() || method.cells[cell].status == CellStatus::not_run) {
    if (map.complete) throw value.bad("is a limit without cells");
    return std::nullopt;
  }
  limit.limits = method.cells[cell].limits;
  return limit;
}

StabilityMap read_stability(const std::filesystem::path& folder, const JsonEntry& root) {
  StabilityMap map;
  map.scene = read_scene_of(root, folder);
  map.options.methods = methods_of(root.at("options"));
  visit_stability(JsonFields(root.at("options")), map.options);
  check_axis(map.options.x);
  check_axis(map.options.y);
  const auto problems = find_problems(map.scene, map.options);
  if (!problems.empty()) throw BadFolder{"study.json: " + problems.front().text()};
  map.x_values = values_of(map.options.x);
  map.y_values = values_of(map.options.y);
  JsonFields fields(root);
  fields("rows", map.rows);
  fields("columns", map.columns);
  map.complete = root.at("complete").flag();
  for (const std::string& method : map.options.methods) map.methods.push_back({method, {}, {}});
  const Rows rows(folder, "stability.csv", root);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::string name = rows.text(row, "method");
    const auto at = std::find_if(map.methods.begin(), map.methods.end(),
                                 [&](const MethodMap& known) { return known.method == name; });
    if (at == map.methods.end()) throw rows.bad(row, "method", name, "is not in study.json");
    read_cell(rows, row, map, *at);
  }
  for (const std::string& name : root.at("limits").keys())
    for (MethodMap& method : map.methods)
      if (method.method == name)
        for (const JsonEntry& value : root.at("limits").at(name).entries())
          if (auto limit = read_limit(value, map, method)) method.measured.push_back(std::move(*limit));
  return map;
}

bool is_planned(const ExtremesTable& table, const ExtremeCell& cell) {
  const auto is_named = [&](const ExtremeCase& extreme) { return extreme.name == cell.case_name; };
  return std::any_of(table.cases.begin(), table.cases.end(), is_named) &&
         std::find(table.methods.begin(), table.methods.end(), cell.method) != table.methods.end();
}

ExtremesTable read_extremes(const std::filesystem::path& folder, const JsonEntry& root) {
  ExtremesOptions options;
  if (root.has("scene")) options.scene = read_scene_of(root, folder);
  options.methods = methods_of(root.at("options"));
  options.cases = root.at("options").at("cases").texts();
  ExtremesTable table = empty_table(options);
  if (table.cases.size() != options.cases.size() || table.methods.size() != options.methods.size())
    throw root.at("options").bad("has a case or method that this version does not have");
  const Rows rows(folder, "extremes.csv", root);
  std::map<std::int64_t, ExtremeCell> cells;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    ExtremeCell cell;
    read_row(rows, row, cell);
    if (!is_planned(table, cell) || !cells.try_emplace(table.number_of(cell), cell).second)
      throw rows.bad(row, "case", cell.case_name,
                     "is no case and method of study.json that is not there yet");
  }
  for (auto& [number, cell] : cells) table.cells.push_back(std::move(cell));
  return table;
}

GridConvergence read_convergence(const std::filesystem::path& folder, const JsonEntry& root) {
  const Scene scene = read_scene_of(root, folder);
  const JsonEntry& from = root.at("options");
  GridConvergenceOptions options{.outputs = from.at("outputs").texts(), .time = from.at("time_s").number()};
  for (const JsonEntry& cells : from.at("cells").entries())
    options.cells.push_back(static_cast<int>(cells.whole<std::int64_t>(1, 1e6)));
  if (options.outputs.empty()) throw from.at("outputs").bad("must not be empty");
  if (options.cells.empty()) throw from.at("cells").bad("must not be empty");
  const auto problems = find_problems(scene, options);
  if (!problems.empty()) throw from.bad(problems.front().text());
  GridConvergence study = plan_grid_convergence(scene, options);
  const Rows rows(folder, csv_name(study), root);
  std::map<int, GridRun> runs;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const auto cells = static_cast<int>(rows.whole(row, "cells", 0, 1e6));
    if (std::find(study.cells.begin(), study.cells.end(), cells) == study.cells.end() || runs.contains(cells))
      throw rows.bad(row, "cells", std::to_string(cells), "is no grid of study.json that is not there yet");
    GridRun run = run_to_make(study, cells);
    read_row(rows, row, run, study);
    runs.emplace(cells, std::move(run));
  }
  for (auto& [cells, run] : runs) study.runs.push_back(std::move(run));
  return study;
}

bool is_of(const Rows& rows, std::size_t row, const ValidationRow& expected) {
  if (row >= rows.size() || rows.text(row, "protocol") != expected.protocol) return false;
  if (!expected.parameter_text.empty()) return rows.text(row, "parameter") == expected.parameter_text;
  const double parameter = rows.number(row, "parameter", 0.0);
  return expected.parameter_name.empty() || parameter == expected.parameter;
}

DrapeFacts read_drape(const Rows& rows, std::size_t row) {
  return {.folds = static_cast<int>(rows.whole(row, "folds", 0, 1e6)),
          .amplitude = rows.number(row, "amplitude_m"),
          .cells_above = rows.number(row, "cells_that_lock")};
}

ValidationValue read_grid(const Rows& rows, std::size_t row, const ValidationRow& of) {
  const int cells = of.cells[of.grids.size()];
  if (rows.whole(row, "cells", 0, 1e6) != cells)
    throw rows.bad(row, "cells", rows.text(row, "cells"), fmt::format("must be {}", cells));
  ValidationValue grid{.cells = cells,
                       .value = rows.number(row, "value"),
                       .error = of.is_measured ? 0 : rows.number(row, "relative_error"),
                       .distance = rows.number(row, "rms_distance", 0.0)};
  if (of.is_measured) grid.drape = read_drape(rows, row);
  return grid;
}

/// The lines of one row, from `row` on; false where they are not all there.
bool read_validation_row(const Rows& rows, std::size_t& row, ValidationRow& into) {
  const auto is_seed = [&] { return !rows.text(row, "seed").empty(); };
  for (; is_of(rows, row, into) && into.grids.size() < into.cells.size() && into.failure.empty(); ++row) {
    into.failure = rows.text(row, "failure");
    if (!rows.text(row, "cells").empty()) into.grids.push_back(read_grid(rows, row, into));
  }
  for (; into.is_measured && is_of(rows, row, into) && is_seed(); ++row)
    into.seeds.push_back({static_cast<std::uint64_t>(rows.whole(row, "seed", 0, 1e9)),
                          rows.number(row, "value"), read_drape(rows, row)});
  return into.grids.size() == into.cells.size() || !into.failure.empty();
}

ValidationStudy read_validation(const std::filesystem::path& folder, const JsonEntry& root) {
  ValidationOptions options;
  const std::vector<std::string> known = validation_protocols();
  for (const JsonEntry& protocol : root.at("options").at("protocols").entries()) {
    if (std::find(known.begin(), known.end(), protocol.text()) == known.end())
      throw protocol.bad("is not a protocol");
    options.protocols.push_back(protocol.text());
  }
  if (options.protocols.empty()) throw root.at("options").at("protocols").bad("must not be empty");
  ValidationStudy study = plan_validation(options);
  const Rows rows(folder, csv_name(study), root), points(folder, validation_points_name, root);
  std::size_t row = 0, point = 0;
  std::vector<std::optional<ValidationRow>> found(study.expected.size());
  while (row < rows.size()) {
    const auto expected = std::find_if(study.expected.begin(), study.expected.end(),
                                       [&](const ValidationRow& one) { return is_of(rows, row, one); });
    const std::size_t first = row, place = static_cast<std::size_t>(expected - study.expected.begin());
    ValidationRow read = place < found.size() && !found[place] ? *expected : ValidationRow{};
    if (read.protocol.empty() || !read_validation_row(rows, row, read)) {
      if (!root.at("complete").flag()) break;  // its last row was not written to its end
      throw rows.bad(first, "protocol", rows.text(first, "protocol"),
                     "is no whole row of study.json that is not there yet");
    }
    for (; is_of(points, point, read); ++point)
      read.shown.emplace_back(points.number(point, "x"), points.number(point, "y"));
    found[place] = std::move(read);
  }
  for (std::optional<ValidationRow>& read : found)
    if (read) study.rows.push_back(std::move(*read));
  return study;
}

IterationsStudy read_iterations(const std::filesystem::path& folder, const JsonEntry& root) {
  constexpr double most_particles = 1e9, most_iterations = 1e6;
  const JsonEntry options = root.at("options");
  IterationsOptions asked{.methods = options.at("methods").texts(),
                          .step = options.at("step_s").number(),
                          .time = options.at("time_s").number(),
                          .most = options.at("most").whole<int>(1, most_iterations)};
  for (const JsonEntry& method : options.at("methods").entries())
    if (std::count(iterated_methods().begin(), iterated_methods().end(), method.text()) == 0)
      throw method.bad("is not a method that iterates");
  if (asked.methods.empty()) throw options.at("methods").bad("must not be empty");
  const Scene scene = read_scene_of(root, folder);
  if (const auto problems = find_problems(scene, asked); !problems.empty())
    throw BadFolder{"study.json: " + problems.front().text()};
  IterationsStudy study = plan_iterations_study(scene, asked);
  study.left_out = root.at("left_out").texts();
  study.time = root.at("time_s").number();
  study.particles = root.at("particles").whole<int>(0, most_particles);
  study.failure = root.at("failure").text();
  study.fall = root.at("fall_J").number();
  study.residual = root.at("residual_N_s").number();
  study.floor = root.at("floor").number();
  study.is_minimum = root.at("is_minimum").flag();
  study.stopped = !root.at("complete").flag();
  const Rows rows(folder, csv_name(study), root);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::string method = rows.text(row, "method");
    if (study.methods.empty() || study.methods.back().method != method) {
      const std::size_t next = study.methods.size();
      if (next >= study.asked.size() || study.asked[next] != method)
        throw rows.bad(row, "method", method, "is not the method that study.json has here");
      study.methods.push_back({.method = method});
    }
    MethodIterations& of = study.methods.back();
    const int fewest = of.steps.empty() ? 1 : of.steps.back().iterations + 1;
    of.steps.push_back({.iterations = static_cast<int>(rows.whole(row, "iterations", fewest, study.most)),
                        .seconds = rows.number(row, "seconds"),
                        .objective = rows.number(row, "relative_objective", NAN)});
    of.remark = rows.text(row, "remark");
  }
  return study;
}

/// The tables that are not those that study.json describes, a clause each. One that is not there at all is
/// said by who reads it.
std::string find_disagreements(const std::filesystem::path& folder, const JsonEntry& root) {
  std::string found, text;
  if (!root.has("files")) return found;  // it is being made, or an old version made it
  for (const FileDigest& expected : digests_of(root.at("files"))) {
    if (!expected.rows || expected.name.find('/') != std::string::npos) continue;
    if (read_text_file(folder / expected.name, text)) continue;
    const std::string what = disagreement(expected, digest_of(expected.name, text, true));
    if (what.empty()) continue;
    found += fmt::format("{}{} {} as study.json says", found.empty() ? "" : "; ", expected.name, what);
  }
  return found;
}

StudyTable read_table(const std::filesystem::path& folder, const JsonEntry& root) {
  const std::string kind = root.at("kind").text();
  if (kind == "work-precision") return read_work_precision(folder, root);
  if (kind == "stability") return read_stability(folder, root);
  if (kind == "extremes") return read_extremes(folder, root);
  if (kind == "convergence") return read_convergence(folder, root);
  if (kind == "validation") return read_validation(folder, root);
  if (kind == "iterations") return read_iterations(folder, root);
  throw root.at("kind").bad(
      "must be work-precision, stability, extremes, convergence, validation or iterations");
}

}  // namespace

StudyReading read_study(const std::filesystem::path& folder) {
  std::string text;
  if (const auto error = read_text_file(folder / "study.json", text))
    return {std::nullopt, error->text(), true};
  if (const auto problem = syntax_problem(text, (folder / "study.json").string()))
    return {std::nullopt, problem->text()};
  const std::string place = (folder / "").string();
  std::string disagreements;
  try {
    const json file = json::parse(text);
    const JsonEntry root(file);
    if (root.at("format").text() != study_format)
      throw root.at("format").bad(fmt::format("must be \"{}\"", study_format));
    disagreements = find_disagreements(folder, root);
    Study study{read_table(folder, root), root.at("command").text(), root.at("wall_s").number()};
    if (root.has("shard")) study.shard = root.at("shard").text();
    if (disagreements.empty()) return {std::move(study), {}};
  } catch (const BadFolder& bad) {
    if (!disagreements.empty()) disagreements += "; ";
    return {std::nullopt, place + disagreements + bad.problem, bad.is_lost || !disagreements.empty()};
  } catch (BadJsonEntry& bad) {
    locate_json(text).put_in_place(bad.problem, place + "study.json");
    if (disagreements.empty()) return {std::nullopt, bad.problem.text()};
  }
  return {std::nullopt, place + disagreements, true};
}

}  // namespace cloth
