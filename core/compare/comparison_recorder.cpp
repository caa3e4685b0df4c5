#include "compare/comparison_recorder.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "compare/comparison_json.h"
#include "io/machine.h"
#include "simulation/recorder.h"

namespace cloth {
namespace {

/// Whether the pane is measured against something.
bool has_difference(const LockStep& lockstep, std::size_t pane) {
  const auto reference = lockstep.reference_lane();
  return reference && *reference != pane;
}

/// The columns of compare.csv and what they hold now.
struct CompareFields {
  std::vector<std::string> names, texts;
  void add(const std::string& name, bool present, double value) {
    names.push_back(name);
    texts.push_back(present ? csv_number(value) : "");
  }
};

CompareFields fields_of(const LockStep& lockstep) {
  CompareFields fields;
  fields.add("time_s", true, lockstep.time_of(lockstep.index()));
  for (std::size_t i = 0; i < lockstep.pane_count(); ++i) {
    const Lane& lane = lockstep.lane(i);
    const Measurement& now = lane.measurement;
    const Quantities& quantities = lane.simulation->quantities();
    const bool going = lane.going();
    const auto add = [&](const char* name, double value) { fields.add(lane.name + name, going, value); };
    add("_total_J", now.energy.total());
    add("_energy_error_J", now.energy_error());
    add("_max_strain", now.strain.maximum());
    if (quantities.limiter) add("_limiter_excess", now.limiter_excess);
    if (quantities.contact) add("_contacts", now.contacts);
    add("_step_time_us", 1e6 * lane.step_time);
    if (!has_difference(lockstep, i)) continue;
    const Difference* difference = lockstep.difference(i);
    fields.add(lane.name + "_rms_difference_m", difference, difference ? difference->rms : 0);
    fields.add(lane.name + "_largest_difference_m", difference, difference ? difference->largest : 0);
  }
  if (lockstep.comparison().reference == controlled_reference)
    fields.add("reference_floor_m", lockstep.floor(), lockstep.floor() ? lockstep.floor()->rms : 0);
  return fields;
}

std::vector<Quantities> quantities_of(const LockStep& lockstep) {
  std::vector<Quantities> all;
  for (std::size_t i = 0; i < lockstep.pane_count(); ++i)
    all.push_back(lockstep.lane(i).simulation->quantities());
  return all;
}

std::vector<std::string> names_of(const Comparison& comparison) {
  std::vector<std::string> names;
  for (const Pane& pane : comparison.panes) names.push_back(pane.name);
  return names;
}

/// Of a recording without a ranking, as the window makes it: what the folder holds.
std::string recording_summary(const ResultFolder& folder) {
  const nlohmann::ordered_json root{{"program", "clothlab"},
                                    {"version", version()},
                                    {"kind", "comparison"},
                                    {"status", name_of(Status::stopped)},
                                    {"files", digests_json(folder.digests())}};
  return root.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

std::vector<std::string> comparison_columns(const LockStep& lockstep) {
  return fields_of(lockstep).names;
}

std::vector<std::string> comparison_row(const LockStep& lockstep) {
  return fields_of(lockstep).texts;
}

FolderUse comparison_use(const Comparison& comparison) {
  FolderUse use{.kind = "comparison",
                .files = {"comparison.json", "compare.csv", "compare.svg", "report.html", "summary.json"}};
  for (const std::string& name : names_of(comparison)) use.files.push_back(name + ".csv");
  for (const std::string& mesh : mesh_files(comparison)) use.inputs.emplace_back(mesh);
  return use;
}

std::optional<IoError> ComparisonRecorder::open(const std::filesystem::path& folder,
                                                const LockStep& lockstep) {
  if (auto error = own_folder_.claim(folder, comparison_use(lockstep.comparison()))) return error;
  return open(own_folder_, lockstep);
}

std::optional<IoError> ComparisonRecorder::open(ResultFolder& folder, const LockStep& lockstep) {
  folder_ = &folder;
  part_ = 0;
  const Comparison moved = moved_to_folder(as_run(lockstep), folder.path().string());
  if (auto error = folder.write("comparison.json", write_comparison(moved))) return error;
  return open_part(lockstep);
}

std::optional<IoError> ComparisonRecorder::open_part(const LockStep& lockstep) {
  if (auto error = close_rows()) return error;
  ++part_;
  names_ = names_of(lockstep.comparison());
  quantities_ = quantities_of(lockstep);
  reference_ = lockstep.comparison().reference;
  const auto begin = [&](CsvFile& file, const std::string& name, const std::vector<std::string>& columns) {
    const std::string part = part_ == 1 ? name + ".csv" : fmt::format("{}-{}.csv", name, part_);
    auto error = folder_->add(part);
    return error ? error : file.open(*folder_ / part, columns);
  };
  panes_.clear();
  for (std::size_t i = 0; i < lockstep.pane_count(); ++i) {
    panes_.push_back(std::make_unique<CsvFile>());
    if (auto error = begin(*panes_[i], lockstep.lane(i).name, record_columns(quantities_[i]))) return error;
  }
  compare_ = std::make_unique<CsvFile>();
  return begin(*compare_, "compare", comparison_columns(lockstep));
}

std::optional<IoError> ComparisonRecorder::add_row(const LockStep& lockstep) {
  if (names_of(lockstep.comparison()) != names_ || quantities_of(lockstep) != quantities_ ||
      lockstep.comparison().reference != reference_)
    if (auto error = open_part(lockstep)) return error;
  for (std::size_t i = 0; i < panes_.size(); ++i) {
    const Lane& lane = lockstep.lane(i);
    if (!lane.going()) continue;
    if (auto error = panes_[i]->add(record_row(lane.measurement, quantities_[i], lane.step_time)))
      return error;
  }
  return compare_->add(comparison_row(lockstep));
}

std::optional<IoError> ComparisonRecorder::log(const std::vector<std::string>& lines) {
  if (lines.empty()) return std::nullopt;
  if (!edits_.is_open()) {
    if (auto error = folder_->add("edits.jsonl")) return error;
    if (auto error = edits_.open(*folder_ / "edits.jsonl")) return error;
  }
  for (const std::string& line : lines)
    if (auto error = edits_.add(line)) return error;
  return std::nullopt;
}

std::optional<IoError> ComparisonRecorder::flush() {
  if (edits_.is_open())
    if (auto error = edits_.flush()) return error;
  for (const auto& pane : panes_)
    if (auto error = pane->flush()) return error;
  return compare_ ? compare_->flush() : std::nullopt;
}

std::optional<IoError> ComparisonRecorder::close() {
  auto error = close_rows();
  if (edits_.is_open()) {
    auto of_edits = edits_.close();
    FileDigest edits = edits_.digest();
    edits.rows.reset();
    folder_->note(edits);
    if (!error) error = std::move(of_edits);
  }
  if (!error && own_folder_.is_open())
    error = own_folder_.finish("summary.json", recording_summary(own_folder_));
  own_folder_.release();
  return error;
}

std::optional<IoError> ComparisonRecorder::close_rows() {
  std::optional<IoError> first;
  const auto end = [&](CsvFile& file) {
    if (!file.is_open()) return;
    auto error = file.close();
    if (!error) folder_->note(file.digest());
    if (error && !first) first = std::move(error);
  };
  for (const auto& pane : panes_) end(*pane);
  if (compare_) end(*compare_);
  return first;
}

Comparison as_run(const LockStep& lockstep) {
  Comparison comparison = lockstep.comparison();
  for (std::size_t i = 0; i < lockstep.pane_count(); ++i)
    if (lockstep.lane(i).simulation->step_changes().empty())  // else no one step repeats it, and "auto" does
      set_own(comparison.panes[i], "integrator.time_step", lockstep.lane(i).simulation->time_step());
  return comparison;
}

}  // namespace cloth
