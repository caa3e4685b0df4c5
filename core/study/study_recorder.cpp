#include "study/study_recorder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/text_file.h"
#include "scene/scene_mesh.h"
#include "study/extremes_report.h"
#include "study/grid_convergence_report.h"
#include "study/iterations_report.h"
#include "study/reference_solution.h"
#include "study/stability_report.h"
#include "study/study_runs.h"
#include "study/validation/validation_report.h"
#include "study/work_precision_report.h"

namespace cloth {
namespace {

using Json = nlohmann::ordered_json;

/// What is not the same in two studies, in words: then one is not the other's beginning.
std::vector<std::string> differences(const Json& before, const Json& now) {
  std::vector<std::string> found;
  const auto value = [](const Json& root, const char* block, const std::string& key) {
    const auto at = root.find(block);
    return at != root.end() && at->is_object() ? at->value(key, Json()) : Json();
  };
  if (before.value("scene_hash", Json()) != now.value("scene_hash", Json())) found.emplace_back("the scene");
  for (const auto& [key, wanted] : now.at("options").items())
    if (value(before, "options", key) != wanted) found.push_back(key);
  for (const char* key : {"version", "instruction_set", "processor"}) {
    const bool has_times = now.at("kind") == "work-precision" || now.at("kind") == "iterations";
    if (key == std::string("processor") && !has_times) continue;  // none to mix
    if (value(before, "made_by", key) != value(now, "made_by", key)) found.emplace_back(key);
  }
  return found;
}

/// Begins a table with the rows that are there, to go on after them.
std::optional<IoError> begin_table(ResultFolder& folder, const char* name, const CsvTable& kept,
                                   CsvFile& file) {
  if (auto error = folder.add(name)) return error;
  if (auto error = write_text_file(folder / name, csv_text(kept, "\n"))) return error;
  return file.open_at_end(folder / name);
}

bool is_finished(const StabilityCell& cell) {
  return cell.status != CellStatus::not_run;
}

/// What the study's file has once these cells are kept: cells that were not run have no row.
CsvTable kept_rows(const StudyTable& table) {
  const auto* map = std::get_if<StabilityMap>(&table);
  if (!map) return std::visit([](const auto& of) { return table_of(of); }, table);
  CsvTable kept{table_of(StabilityMap{}).header, {}};
  for (const MethodMap& method : map->methods)
    for (const StabilityCell& cell : method.cells)
      if (is_finished(cell)) kept.rows.push_back(written(cell, method.method).texts);
  return kept;
}

/// Whether there is anything that need not be made again.
bool has_beginning(const StudyTable& table) {
  const auto* study = std::get_if<WorkPrecision>(&table);
  return finished_runs(table) > 0 || (study && study->reference.is_known());
}

/// The states of the reference from their file, to the bit. Where it is not the one that `index`, the
/// folder's study.json, describes, they stay away, and whoever needs them solves the reference again.
std::optional<FileDigest> restore_reference(const std::filesystem::path& place, const std::string& index,
                                            StudyTable& table) {
  auto* study = std::get_if<WorkPrecision>(&table);
  if (!study || !study->reference.is_known()) return std::nullopt;
  const Json reference = Json::parse(index).at("reference");
  std::string bytes;
  if (!reference.contains("states") ||
      read_text_file(place / reference_states_name, bytes, largest_mesh_text))
    return std::nullopt;
  const FileDigest found = digest_of(reference_states_name, bytes, false);
  if (reference.at("states") != digests_json({found})) return std::nullopt;
  study->reference.states = states_from(bytes, study->particles, study->samples, study->horizon);
  if (study->reference.states.empty()) return std::nullopt;
  return found;
}

bool lacks_states(const StudyTable& table) {
  const auto* study = std::get_if<WorkPrecision>(&table);
  return study && study->reference.states.empty();
}

/// What is decided anew by what is left of the budget, and methods that were under way.
void forget_refused(StudyTable& table) {
  if (auto* study = std::get_if<WorkPrecision>(&table))
    for (MethodStudy& method : study->methods)
      std::erase_if(method.runs,
                    [](const WorkPrecisionRun& run) { return run.status == RunStatus::refused; });
  if (auto* study = std::get_if<IterationsStudy>(&table))
    std::erase_if(study->methods,
                  [study](const MethodIterations& method) { return !is_finished(method, study->most); });
}

}  // namespace

/// An unfinished study as its folder has it.
struct StudyRecorder::Unfinished {
  std::optional<Study> study;  ///< none: there is nothing to go on with
  std::string index;           ///< its study.json
  std::string maker;           ///< its folder and machine
};

std::optional<IoError> StudyRecorder::begin(const std::filesystem::path& folder, const StudyTable& plan,
                                            const StudyStart& start) {
  command_ = start.command;
  shard_ = start.shard;
  earlier_.reset();
  states_.reset();
  parts_ = 0;
  wall_of_parts_ = 0;
  disagreements_.clear();
  FolderUse use{.kind = kind_of(plan), .files = study_files(plan), .inputs = start.inputs};
  if (const Scene* scene = scene_of(plan))
    for (const std::string& mesh : mesh_files(*scene)) use.inputs.emplace_back(mesh);
  if (auto error = folder_.lock(shard_ ? part_folder(folder, *shard_) : folder, use)) return error;
  auto refused = start.overwrite ? std::nullopt : look_at_earlier(plan);
  const bool goes_on = earlier_.has_value();  // in this folder, not in those of parts alone
  if (!start.overwrite && !refused) refused = take_parts(folder, plan, start);
  if (refused) {
    folder_.release();
    return refused;
  }
  if (auto error = goes_on ? folder_.go_on() : folder_.begin_anew()) return error;
  // Before the tables change, so that no study.json ever has the digests of other tables.
  if (auto error = write_index(earlier_ ? earlier_->table : plan)) return error;
  return begin_tables(earlier_ ? earlier_->table : plan);
}

/// What of the study's beginning lies in a folder; refuses what is the beginning of another one.
std::optional<IoError> StudyRecorder::read_unfinished(const std::filesystem::path& place,
                                                      const StudyTable& plan, Unfinished& found) const {
  std::error_code ignored;
  if (!std::filesystem::exists(place / "study.json", ignored)) return std::nullopt;
  if (auto error = read_text_file(place / "study.json", found.index)) return error;
  const Json before = Json::parse(found.index, nullptr, false);
  if (!before.is_object() || before.value("complete", Json()) != Json(false)) return std::nullopt;
  const auto refused = [&](const std::string& why) {
    const char* advice = place == folder_.path() ? "or --overwrite to begin anew" : "or remove this one";
    return IoError{place, fmt::format("holds an unfinished study {}: give another folder, {}", why, advice),
                   true};
  };
  StudyReading reading = read_study(place);
  if (!reading.study) reading = read_study(place);  // its process may just have begun its tables anew,
  if (!std::filesystem::exists(place / "study.json", ignored)) return std::nullopt;  // or the whole folder
  if (!reading.study) return refused("that cannot be read (" + reading.problem + ")");
  if (!has_beginning(reading.study->table)) return std::nullopt;
  const Json now = Json::parse(study_index(place, plan, command_, 0, {}));
  if (before.value("kind", Json()) != now.at("kind")) return refused("of another kind");
  if (const auto others = differences(before, now); !others.empty())
    return refused(fmt::format("of other inputs (not the same: {})", fmt::join(others, ", ")));
  const Json maker = before.value("made_by", Json::object());
  found.maker = fmt::format("{} ({}, {})", place.string(), maker.value("processor", ""),
                            maker.value("instruction_set", ""));
  forget_refused(reading.study->table);
  found.study = std::move(reading.study);
  return std::nullopt;
}

std::optional<IoError> StudyRecorder::look_at_earlier(const StudyTable& plan) {
  Unfinished found;
  if (auto error = read_unfinished(folder_.path(), plan, found)) return error;
  earlier_ = std::move(found.study);
  if (earlier_) states_ = restore_reference(folder_.path(), found.index, earlier_->table);
  return std::nullopt;
}

std::optional<IoError> StudyRecorder::take_parts(const std::filesystem::path& folder, const StudyTable& plan,
                                                 const StudyStart& start) {
  StudyParts all(plan, start.shard);
  if (earlier_) all.add(earlier_->table, folder_.path().string());
  std::vector<std::filesystem::path> places = part_folders(folder);
  if (shard_) places.push_back(folder);  // what a whole study had made when it was stopped
  for (const std::filesystem::path& place : places) {
    if (place == folder_.path()) continue;
    Unfinished part;
    if (auto error = read_unfinished(place, plan, part)) return error;
    if (!part.study) continue;
    if (lacks_states(all.table())) restore_reference(place, part.index, part.study->table);
    all.add(part.study->table, part.maker);
    ++parts_;
    wall_of_parts_ += part.study->wall;
  }
  disagreements_ = all.disagreements();
  if (!disagreements_.empty())
    return IoError{folder, "parts of the study do not agree: " + disagreements_.front(), true};
  if (parts_ == 0 || !has_beginning(all.table())) return std::nullopt;
  earlier_ = Study{all.table(), command_, earlier_ ? earlier_->wall : 0};
  if (auto* study = std::get_if<WorkPrecision>(&earlier_->table); study && !shard_) study->parts = parts_;
  return std::nullopt;
}

std::optional<IoError> StudyRecorder::begin_tables(const StudyTable& table) {
  rows_kept_.clear();
  samples_kept_.clear();
  cells_kept_.clear();
  map_kept_.clear();
  limits_kept_ = 0;
  step_kept_ = false;
  if (const auto* study = std::get_if<WorkPrecision>(&table)) {
    for (const MethodStudy& method : study->methods) {
      rows_kept_.push_back(method.runs.size());
      samples_kept_.emplace_back();
      for (const WorkPrecisionRun& run : method.runs) samples_kept_.back().push_back(run.samples.size());
    }
    if (auto error = begin_table(folder_, csv_name(table), kept_rows(table), rows_)) return error;
    return begin_table(folder_, samples_name, sample_table(*study), samples_);
  }
  if (const auto* map = std::get_if<StabilityMap>(&table)) {
    for (const MethodMap& method : map->methods) {
      map_kept_.emplace_back();
      for (const StabilityCell& cell : method.cells) map_kept_.back().push_back(is_finished(cell));
      limits_kept_ += method.measured.size();
    }
  } else if (const auto* grids = std::get_if<GridConvergence>(&table)) {
    for (const GridRun& run : grids->runs) cells_kept_.insert(run.cells);
  } else if (const auto* validation = std::get_if<ValidationStudy>(&table)) {
    for (const ValidationRow& row : validation->rows) cells_kept_.insert(validation->number_of(row));
    if (auto error = begin_table(folder_, validation_points_name, points_table(*validation), samples_))
      return error;
  } else if (const auto* iterations = std::get_if<IterationsStudy>(&table)) {
    for (const MethodIterations& method : iterations->methods) rows_kept_.push_back(method.steps.size());
  } else {
    const auto& extremes = std::get<ExtremesTable>(table);
    for (const ExtremeCell& cell : extremes.cells) cells_kept_.insert(extremes.number_of(cell));
  }
  return begin_table(folder_, csv_name(table), kept_rows(table), rows_);
}

std::optional<IoError> StudyRecorder::write_index(const StudyTable& so_far) {
  if (auto error = folder_.add("study.json")) return error;
  const double wall = earlier_ ? earlier_->wall : 0;
  return write_text_file(folder_ / "study.json",
                         study_index(folder_.path(), so_far, command_, wall, {}, states_, shard_));
}

std::optional<IoError> StudyRecorder::keep(const StudyTable& so_far) {
  return std::visit([this](const auto& table) { return keep(table); }, so_far);
}

std::optional<IoError> StudyRecorder::keep(const WorkPrecision& so_far) {
  if (!states_ && !so_far.reference.states.empty()) {
    const std::string bytes = bytes_of(so_far.reference.states);
    if (auto error = folder_.write(reference_states_name, bytes)) return error;
    states_ = digest_of(reference_states_name, bytes, false);
    if (auto error = write_index(so_far)) return error;
  }
  for (std::size_t m = 0; m < so_far.methods.size(); ++m) {
    const MethodStudy& method = so_far.methods[m];
    for (std::size_t& k = rows_kept_[m]; k < method.runs.size(); ++k) {
      if (auto error = rows_.add(written(method.runs[k], so_far, method).texts)) return error;
      samples_kept_[m].push_back(0);
    }
    for (std::size_t r = 0; r < method.runs.size(); ++r)
      for (std::size_t& k = samples_kept_[m][r]; k < method.runs[r].samples.size(); ++k)
        if (auto error = samples_.add(written(method.runs[r].samples[k], method, method.runs[r]).texts))
          return error;
  }
  if (auto error = rows_.flush()) return error;  // first: a sample names its run
  return samples_.flush();
}

std::optional<IoError> StudyRecorder::keep(const StabilityMap& so_far) {
  map_kept_.resize(so_far.methods.size());
  std::size_t limits = 0;
  for (std::size_t m = 0; m < so_far.methods.size(); ++m) {
    const MethodMap& method = so_far.methods[m];
    map_kept_[m].resize(method.cells.size());
    for (std::size_t k = 0; k < method.cells.size(); ++k) {
      if (!is_finished(method.cells[k]) || map_kept_[m][k]) continue;
      map_kept_[m][k] = true;
      if (auto error = rows_.add(written(method.cells[k], method.method).texts)) return error;
    }
    limits += method.measured.size();
  }
  if (auto error = rows_.flush()) return error;
  if (limits <= limits_kept_) return std::nullopt;
  limits_kept_ = limits;
  return write_index(so_far);
}

std::optional<IoError> StudyRecorder::keep(const ExtremesTable& so_far) {
  for (const ExtremeCell& cell : so_far.cells)
    if (cells_kept_.insert(so_far.number_of(cell)).second)
      if (auto error = rows_.add(written(cell).texts)) return error;
  return rows_.flush();
}

std::optional<IoError> StudyRecorder::keep(const GridConvergence& so_far) {
  for (const GridRun& run : so_far.runs)
    if (cells_kept_.insert(run.cells).second)
      if (auto error = rows_.add(written(run, so_far).texts)) return error;
  return rows_.flush();
}

std::optional<IoError> StudyRecorder::keep(const ValidationStudy& so_far) {
  for (const ValidationRow& row : so_far.rows) {
    if (!cells_kept_.insert(so_far.number_of(row)).second) continue;
    for (const auto& line : point_lines(row))
      if (auto error = samples_.add(line)) return error;
    for (const auto& line : lines_of(row))
      if (auto error = rows_.add(line)) return error;
  }
  if (auto error = samples_.flush()) return error;  // first: a row that is there has its points
  return rows_.flush();
}

/// No cell that was not run has a row, and the states stay: whoever makes the whole study may need them.
std::optional<IoError> StudyRecorder::end_part(const StudyTable& table, double wall) {
  std::string text;
  // Several jobs end cells in any order.
  if (auto error = write_text_file(folder_ / csv_name(table), csv_text(kept_rows(table), "\n"))) return error;
  if (const auto* validation = std::get_if<ValidationStudy>(&table)) {
    text = csv_text(points_table(*validation), "\n");
    if (auto error = write_text_file(folder_ / validation_points_name, text)) return error;
  }
  for (const std::string& name : study_files(table)) {
    if (!name.ends_with(".csv")) continue;
    if (auto error = read_text_file(folder_ / name, text)) return error;
    folder_.note(digest_of(name, text, true));
  }
  if (states_) folder_.note(*states_);
  return folder_.finish(
      "study.json", study_index(folder_.path(), table, command_, wall, folder_.digests(), states_, shard_));
}

std::optional<IoError> StudyRecorder::keep(const IterationsStudy& so_far) {
  rows_kept_.resize(std::max(rows_kept_.size(), so_far.methods.size()));
  for (std::size_t m = 0; m < so_far.methods.size(); ++m)
    for (std::size_t& k = rows_kept_[m]; k < so_far.methods[m].steps.size(); ++k)
      if (auto error = rows_.add(line_of(so_far.methods[m], k))) return error;
  if (auto error = rows_.flush()) return error;
  if (std::exchange(step_kept_, true)) return std::nullopt;
  return write_index(so_far);
}

std::optional<IoError> StudyRecorder::end(const StudyTable& table, double wall) {
  if (earlier_) wall += earlier_->wall;
  if (auto error = rows_.close()) return error;
  if (auto error = samples_.close()) return error;
  if (shard_) return end_part(table, wall);
  if (is_complete(table)) wall += wall_of_parts_;  // who goes on with it adds them up again
  if (auto error = folder_.write(csv_name(table), study_csv(table), true)) return error;
  if (const auto* study = std::get_if<WorkPrecision>(&table)) {
    const std::string samples = csv_text(sample_table(*study), "\n");
    if (auto error = folder_.write(samples_name, samples, true)) return error;
    if (is_complete(table)) {
      states_.reset();
      if (auto error = folder_.remove(reference_states_name)) return error;
    } else if (states_) {
      folder_.note(*states_);  // an earlier part of the study may have written it
    }
  }
  if (const auto* validation = std::get_if<ValidationStudy>(&table))
    if (auto error = folder_.write(validation_points_name, csv_text(points_table(*validation), "\n"), true))
      return error;
  const std::string svg = std::visit([](const auto& of) { return to_svg(study_plot(of)); }, table);
  const std::string page = std::visit([&](const auto& of) { return study_page(of, command_, wall); }, table);
  const std::string svg_name = std::filesystem::path(csv_name(table)).replace_extension("svg").string();
  if (auto error = folder_.write(svg_name, svg)) return error;
  if (const auto* grids = std::get_if<GridConvergence>(&table))
    if (auto error = folder_.write(grid_errors_name, to_svg(study_plot(*grids, GridPlot::errors))))
      return error;
  if (const auto* iterations = std::get_if<IterationsStudy>(&table))
    if (auto error =
            folder_.write(iterations_time_name, to_svg(study_plot(*iterations, IterationsAgainst::time))))
      return error;
  if (auto error = folder_.write("report.html", page)) return error;
  return folder_.finish("study.json",
                        study_index(folder_.path(), table, command_, wall, folder_.digests(), states_));
}

std::optional<IoError> StudyRecorder::write(const std::filesystem::path& folder, const StudyTable& table,
                                            const std::string& command, double wall) {
  StudyRecorder recorder;
  recorder.command_ = command;
  if (auto error = recorder.folder_.claim(folder, {.kind = kind_of(table), .files = study_files(table)}))
    return error;
  return recorder.end(table, wall);
}

}  // namespace cloth
