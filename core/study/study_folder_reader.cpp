#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "cloth/mesh_cloth.h"
#include "contact/start_check.h"
#include "integrators/registry.h"
#include "io/csv.h"
#include "io/json_entry.h"
#include "io/json_locator.h"
#include "io/json_syntax.h"
#include "io/text_file.h"
#include "scene/scene_checks.h"
#include "scene/scene_json.h"
#include "study/stability_report.h"
#include "study/study_folder.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

/// What is wrong with a folder, on its way to the reader's caller; never leaves this file.
struct BadFolder {
  std::string problem;
  bool is_lost = false;  ///< see StudyReading
};

/// A CSV file of the folder, by row and column name.
class Rows {
 public:
  /// Of a study that is being made, or was killed, a table may not be there yet, and a loss of power may have
  /// cut its last line.
  Rows(const std::filesystem::path& folder, const char* name, const JsonEntry& root) : name_(name) {
    std::string text;
    const bool grows = !root.has("files") && !root.at("complete").flag();
    if (grows && !std::filesystem::exists(folder / name)) return;
    if (const auto error = read_text_file(folder / name, text))
      throw BadFolder{fmt::format("{}: {}", name, error->message), true};
    if (grows) text.resize(text.rfind('\n') + 1);  // npos + 1 is 0
    table_ = parse_csv(text);
    for (std::size_t k = 0; k < table_.header.size(); ++k) columns_[table_.header[k]] = k;
  }

  std::size_t size() const { return table_.rows.size(); }
  bool has(const char* column) const { return columns_.contains(column); }
  std::string text(std::size_t row, const char* column) const {
    const auto at = columns_.find(column);
    if (at == columns_.end()) throw BadFolder{fmt::format("{}: has no column \"{}\"", name_, column)};
    const auto& fields = table_.rows[row];
    if (at->second >= fields.size()) throw bad(row, column, "", "is missing");
    return fields[at->second];
  }
  /// `empty`: the value of an empty field; none: it may not be empty.
  double number(std::size_t row, const char* column, std::optional<double> empty = {}) const {
    const std::string field = text(row, column);
    if (field.empty() && empty) return *empty;
    double value = 0;
    const char* end = field.data() + field.size();
    const auto [last, error] = std::from_chars(field.data(), end, value);
    if (error != std::errc() || last != end || field.empty())
      throw bad(row, column, field, "must be a number");
    return value;
  }
  std::int64_t count(std::size_t row, const char* column) const {
    const double value = number(row, column, 0.0);
    if (!(std::abs(value) < 1e18)) throw bad(row, column, text(row, column), "must be a whole number");
    return static_cast<std::int64_t>(value);
  }
  int small(std::size_t row, const char* column, int least, int most) const {
    const std::int64_t value = count(row, column);
    if (value < least || value > most)
      throw bad(row, column, text(row, column), fmt::format("must be from {} to {}", least, most));
    return static_cast<int>(value);
  }
  BadFolder bad(std::size_t row, const char* column, const std::string& value,
                const std::string& rule) const {
    return {fmt::format("{}, line {}, {}: \"{}\" {}", name_, row + 2, column, value, rule)};
  }

 private:
  std::string name_;
  CsvTable table_;
  std::map<std::string, std::size_t> columns_;
};

double number_or(const JsonEntry& value, double otherwise) {
  return value.is_null() ? otherwise : value.number();
}

constexpr double largest_count = 1e9;  // of what is kept in an int

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

template <class Status>
Status status_named(const Rows& rows, std::size_t row, const std::vector<Status>& known) {
  const std::string name = rows.text(row, "status");
  for (const Status status : known)
    if (name == name_of(status)) return status;
  throw rows.bad(row, "status", name, "is not a status");
}

StateDifference difference_of(const JsonEntry& value) {
  return {value.at("rms_position_m").number(), value.at("largest_position_m").number(),
          value.at("rms_velocity_m_s").number()};
}

WorkPrecisionRun read_run(const Rows& rows, std::size_t row) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  WorkPrecisionRun run;
  run.rung = rows.small(row, "rung", -1, 60);
  run.tolerance = rows.number(row, "tolerance", 0);
  run.time_step = rows.number(row, "time_step", nan);
  run.steps = rows.count(row, "steps");
  run.count.force_evaluations = rows.count(row, "force_evaluations");
  run.count.factorisations = rows.count(row, "factorisations");
  run.count.iterations = rows.count(row, "iterations");
  run.count.linear_iterations = rows.count(row, "linear_iterations");
  run.count.velocity_iterations = rows.count(row, "velocity_iterations");
  run.count.limiter_sweeps = rows.count(row, "limiter_sweeps");
  run.count.rejected_steps = rows.count(row, "rejected_steps");
  run.limiter_iterations = rows.count(row, "limiter_iterations");
  run.error = {rows.number(row, "rms_error_m", nan), rows.number(row, "largest_error_m", nan),
               rows.number(row, "rms_velocity_error_m_s", nan)};
  run.energy_error = rows.number(row, "energy_error_J", nan);
  run.status = status_named<RunStatus>(rows, row,
                                       {RunStatus::stable, RunStatus::energy_growth, RunStatus::diverged,
                                        RunStatus::solver_failed, RunStatus::refused});
  run.detail = rows.text(row, "detail");
  if (rows.has("estimated_s")) run.estimated = rows.number(row, "estimated_s", 0);
  return run;
}

/// What names a run in both tables.
std::string key_of(const Rows& rows, std::size_t row) {
  return rows.text(row, "method") + "|" + rows.text(row, "time_step") + "|" + rows.text(row, "steps") + "|" +
         rows.text(row, "tolerance");
}

WorkPrecision read_work_precision(const std::filesystem::path& folder, const JsonEntry& root) {
  WorkPrecision study;
  study.scene = read_scene_of(root, folder);
  study.particles = study.scene.cloth.rows * study.scene.cloth.columns;
  study.diagonal = diagonal_of(study.scene.cloth);
  const JsonEntry& options = root.at("options");
  const double horizon = options.at("horizon_s").number();
  const auto methods = methods_of(options);
  if (const auto rule = broken_horizon_rule(study.scene, methods, horizon))
    throw options.at("horizon_s").bad(*rule);
  study.repeats = options.at("repeats").whole<int>(0, largest_count);
  study.steps_per_method = options.has("runs_per_method")
                               ? options.at("runs_per_method").whole<int>(0, largest_count)
                               : WorkPrecisionOptions{}.steps_per_method;
  study.budget = options.at("budget_s").number();
  study.estimated = root.at("estimated_s").number();
  study.stopped = !root.at("complete").flag();
  const JsonEntry& reference = root.at("reference");
  study.reference = {.states = {},
                     .floor = difference_of(reference.at("floor")),
                     .excited_frequency = reference.at("excited_frequency_per_s").number(),
                     .largest_kinetic = reference.at("largest_kinetic_J").number(),
                     .smooth = reference.at("smooth").flag(),
                     .first = reference.at("first").text(),
                     .second = reference.at("second").text(),
                     .evaluations = reference.at("evaluations").whole<std::int64_t>(0, largest_whole),
                     .failure = reference.at("failure").text()};
  Ladders ladders = make_ladders(study.scene, methods, horizon);
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
    at->runs.push_back(read_run(rows, row));
  }
  const Rows samples(folder, "work_precision_samples.csv", root);
  for (std::size_t row = 0; row < samples.size(); ++row) {
    const auto at = places.find(key_of(samples, row));
    if (at == places.end()) throw samples.bad(row, "method", samples.text(row, "method"), "has no such run");
    study.methods[at->second.first].runs[at->second.second].samples.push_back(
        {samples.small(row, "repeat", 0, 1'000'000), samples.small(row, "turn", 0, 1'000'000),
         samples.number(row, "wall_s")});
  }
  conclude(study);
  return study;
}

StudyAxis axis_of(const JsonEntry& value) {
  StudyAxis axis{.path = value.at("path").text(),
                 .low = value.at("low").number(),
                 .high = value.at("high").number(),
                 .count = value.at("count").whole<int>(0, largest_count),
                 .scale = value.at("logarithmic").flag() ? AxisScale::logarithmic : AxisScale::linear};
  const auto checked =
      parse_axis(axis_text(axis), "study.json, axis");  // the same rules as on the command line
  if (const auto* problem = std::get_if<Problem>(&checked)) throw BadFolder{problem->text()};
  return axis;
}

StabilityOptions options_of(const JsonEntry& value) {
  StabilityOptions options{.methods = methods_of(value),
                           .x = axis_of(value.at("x")),
                           .y = axis_of(value.at("y")),
                           .full_size = value.at("full_size").flag()};
  const JsonEntry& criterion = value.at("criterion");
  options.criterion = {
      .periods = criterion.at("periods").number(),
      .least_steps = criterion.at("least_steps").whole<int>(0, largest_count),
      .most_steps = criterion.at("most_steps").whole<int>(0, largest_count),
      .perturbation = criterion.at("perturbation").number(),
      .perturbation_seed = criterion.at("perturbation_seed").whole<unsigned>(0, 4294967295.0),
      .growth = criterion.at("growth").number(),
      .growth_factor = criterion.at("growth_factor").number(),
      .accuracy = criterion.at("accuracy").number()};
  return options;
}

StabilityCell read_cell(const Rows& rows, std::size_t row) {
  StabilityCell cell;
  cell.x = rows.number(row, "x");
  cell.y = rows.number(row, "y");
  cell.energy_ratio = rows.number(row, "energy_ratio", 0);
  cell.growth_rate = rows.number(row, "growth_rate_per_s", 0);
  cell.time_step = rows.number(row, "time_step_s");
  cell.steps = rows.count(row, "steps");
  cell.wanted_steps = rows.count(row, "wanted_steps");
  cell.detail = rows.text(row, "detail");
  cell.limits = {rows.number(row, "predicted_limit_s"), rows.number(row, "guaranteed_limit_s"),
                 rows.number(row, "provot_s"), rows.number(row, "spectrum_limit_s")};
  const std::string status = rows.text(row, "status");
  for (const CellStatus general : {CellStatus::not_run, CellStatus::refused, CellStatus::run})
    for (int run_class = 0; run_class < static_cast<int>(run_classes().size()); ++run_class) {
      cell.status = general;
      cell.run_class = static_cast<RunClass>(general == CellStatus::run ? run_class : 0);
      if (status_of(cell) == status) return cell;
    }
  throw rows.bad(row, "status", status, "is not a status");
}

StabilityMap read_stability(const std::filesystem::path& folder, const JsonEntry& root) {
  StabilityMap map;
  map.scene = read_scene_of(root, folder);
  map.options = options_of(root.at("options"));
  const auto problems = find_problems(map.scene, map.options);
  if (!problems.empty()) throw BadFolder{"study.json: " + problems.front().text()};
  map.x_values = values_of(map.options.x);
  map.y_values = values_of(map.options.y);
  map.rows = root.at("rows").whole<int>(0, largest_count);
  map.columns = root.at("columns").whole<int>(0, largest_count);
  map.complete = root.at("complete").flag();
  for (const std::string& method : map.options.methods) map.methods.push_back({method, {}, {}});
  const Rows rows(folder, "stability.csv", root);
  const std::size_t most = map.x_values.size() * map.y_values.size();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::string name = rows.text(row, "method");
    const auto at = std::find_if(map.methods.begin(), map.methods.end(),
                                 [&](const MethodMap& known) { return known.method == name; });
    if (at == map.methods.end() || at->cells.size() == most)
      throw rows.bad(row, "method", name, "is not in study.json, or has more cells than its axes");
    at->cells.push_back(read_cell(rows, row));
  }
  const bool x_is_step = map.options.x.path == time_step_path;
  for (const std::string& name : root.at("limits").keys())
    for (MethodMap& method : map.methods)
      if (method.method == name)
        for (const JsonEntry& value : root.at("limits").at(name).entries()) {
          const std::size_t k = method.measured.size();
          const std::size_t cell = x_is_step ? k * map.x_values.size() + map.x_values.size() - 1
                                             : (map.y_values.size() - 1) * map.x_values.size() + k;
          if (cell >= method.cells.size()) throw value.bad("is more than there are cells");
          method.measured.push_back(
              {.other = value.at("at").number(),
               .longest_stable = value.at("longest_stable_s").number(),
               .shortest_unstable = number_or(value.at("shortest_unstable_s"), infinity),
               .stable_beyond = value.at("stable_beyond").flag(),
               .limits = method.cells[cell].limits});
        }
  return map;
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
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::size_t extreme = row / table.methods.size();
    ExtremeCell cell{.case_name = rows.text(row, "case"), .method = rows.text(row, "method"), .detail = {}};
    if (extreme >= table.cases.size() || cell.case_name != table.cases[extreme].name ||
        cell.method != table.methods[row % table.methods.size()])
      throw rows.bad(row, "case", cell.case_name, "is not the case and method that study.json has here");
    cell.status = status_named(rows, row, extreme_statuses());
    cell.detail = rows.text(row, "detail");
    cell.time_step = rows.number(row, "time_step_s");
    cell.steps = rows.count(row, "steps");
    cell.ended_early = rows.count(row, "ended_early") != 0;
    cell.max_strain = rows.number(row, "max_strain");
    cell.energy_ratio = rows.number(row, "energy_ratio");
    cell.wall = rows.number(row, "wall_s");
    table.cells.push_back(std::move(cell));
  }
  return table;
}

std::vector<FileDigest> digests_in(const JsonEntry& files) {
  for (const std::string& name : files.keys()) {
    const JsonEntry file = files.at(name);
    file.at("bytes").whole<std::uint64_t>(0, largest_whole);
    if (file.has("rows")) file.at("rows").whole<std::int64_t>(0, largest_whole);
    file.at("fnv1a_64").text();
  }
  return digests_of(files.value());
}

/// The tables that are not those that study.json describes, a clause each. One that is not there at all is
/// said by who reads it.
std::string find_disagreements(const std::filesystem::path& folder, const JsonEntry& root) {
  std::string found, text;
  if (!root.has("files")) return found;  // it is being made, or an old version made it
  for (const FileDigest& expected : digests_in(root.at("files"))) {
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
  throw root.at("kind").bad("must be work-precision, stability or extremes");
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
