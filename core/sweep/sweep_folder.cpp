#include "sweep/sweep_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <nlohmann/json.hpp>

#include "io/json_entry.h"
#include "io/json_syntax.h"
#include "io/machine.h"
#include "io/process.h"
#include "kernels/instruction_set.h"
#include "sweep/sweep_points.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Index files of other results.
constexpr const char* other_indices[] = {"summary.json", "study.json",    "reproduce.json",
                                         "bench.json",   "measured.json", "strips.json"};

std::string index_text(const SweepFolder& folder) {
  const auto quoted = [](const std::string& text) { return json(text).dump(); };
  std::string plan = indented_json(write_sweep(folder.plan));
  return fmt::format(
      "{{\n  \"format\": \"{}\",\n  \"version\": {},\n  \"instruction_set\": {},\n  \"plan_hash\": {},\n"
      "  \"points\": {},\n  \"plan\": {}\n}}\n",
      sweep_folder_format, quoted(folder.version), quoted(folder.instruction_set), quoted(folder.hash),
      point_count(folder.plan), plan);
}

/// Writes a file that is whole from the start, where there is none yet: the first of several wins.
std::optional<IoError> write_once(const fs::path& path, const std::string& text) {
  const auto [draft, descriptor] = begin_draft(path);
  if (descriptor < 0) return system_error(path);
  std::optional<IoError> failure;
  if (!write_to_disk(descriptor, text)) failure = system_error(path);
  if (::close(descriptor) != 0 && !failure) failure = system_error(path);
  if (!failure && ::link(draft.c_str(), path.c_str()) != 0 && errno != EEXIST) {
    // A file system without links: whoever comes later writes the same or is found out.
    if (::rename(draft.c_str(), path.c_str()) != 0) failure = system_error(path);
  }
  ::unlink(draft.c_str());
  if (!failure) sync_folder(path.parent_path());
  return failure;
}

/// Throws BadJsonEntry.
SweepFolderReading folder_of(const fs::path& path, const json& root) {
  const JsonEntry entry(root);
  if (entry.at("format").text() != sweep_folder_format)
    throw entry.at("format").bad(fmt::format("must be \"{}\"", sweep_folder_format));
  SweepFolder folder{.path = path,
                     .hash = entry.at("plan_hash").text(),
                     .version = entry.at("version").text(),
                     .instruction_set = entry.at("instruction_set").text()};
  const std::string place = (path / sweep_index_name).string();
  SweepReading reading = read_sweep(entry.at("plan").value().dump(), place, path);
  if (!reading.plan) {
    for (Problem& problem : reading.problems)
      if (problem.place == place) problem.line = problem.column = 0;  // of the plan alone
    return {.problems = std::move(reading.problems)};
  }
  folder.plan = std::move(*reading.plan);
  if (plan_hash(folder.plan) != folder.hash)
    return {.error = IoError{path / sweep_index_name,
                             "its plan is not the one that its hash is of: it or a mesh was changed", true}};
  return {.folder = std::move(folder)};
}

IoError refusal(const fs::path& path, const std::string& what) {
  return {path, what + ": give another folder", true};
}

/// Why a plan's points cannot be added to a folder.
std::optional<IoError> difference(const SweepFolder& there, const SweepFolder& wanted) {
  if (there.hash != wanted.hash) return refusal(there.path, "holds a sweep of another plan");
  if (there.version != wanted.version)
    return refusal(there.path, fmt::format("holds a sweep made by version {}, and this is version {}",
                                           there.version, wanted.version));
  if (there.instruction_set != wanted.instruction_set)
    return IoError{there.path,
                   fmt::format("holds a sweep made with the instruction set {}, and this is {}: set {}={} in "
                               "the environment, or give another folder",
                               there.instruction_set, wanted.instruction_set, instruction_set_variable,
                               there.instruction_set),
                   true};
  return std::nullopt;
}

}  // namespace

SweepFolderReading read_sweep_folder(const fs::path& path) {
  std::string text;
  if (auto error = read_text_file(path / sweep_index_name, text)) return {.error = std::move(error)};
  const std::string place = (path / sweep_index_name).string();
  if (auto problem = syntax_problem(text, place)) return {.problems = {std::move(*problem)}};
  try {
    return folder_of(path, json::parse(text));
  } catch (const BadJsonEntry& bad) {
    Problem problem = bad.problem;
    locate_json(text).put_in_place(problem, place);
    return {.problems = {std::move(problem)}};
  }
}

SweepFolderReading take_sweep_folder(const fs::path& path, const SweepPlan& plan) {
  if (auto error = make_folder(path)) return {.error = std::move(error)};
  SweepFolder wanted{
      .path = path, .plan = plan, .version = version(), .instruction_set = name_of(active_instruction_set())};
  wanted.plan.scene = moved_to_folder(plan.scene, path.string());
  wanted.hash = plan_hash(wanted.plan);
  std::error_code ignored;
  for (const char* other : other_indices)
    if (fs::exists(path / other, ignored)) return {.error = refusal(path, "holds other results")};
  if (!fs::exists(path / sweep_index_name, ignored))
    if (auto error = write_once(path / sweep_index_name, index_text(wanted)))
      return {.error = std::move(error)};
  if (auto error = make_folder(wanted.shards())) return {.error = std::move(error)};
  SweepFolderReading there = read_sweep_folder(path);
  if (!there.folder) return there;
  if (auto error = difference(*there.folder, wanted)) return {.error = std::move(error)};
  return there;
}

SweepFolderReading resume_sweep_folder(const fs::path& path) {
  SweepFolderReading there = read_sweep_folder(path);
  if (!there.folder) return there;
  SweepFolder wanted{.path = path, .hash = there.folder->hash};
  wanted.version = version();
  wanted.instruction_set = name_of(active_instruction_set());
  if (auto error = difference(*there.folder, wanted)) return {.error = std::move(error)};
  return there;
}

ShardFiles read_shard_files(const SweepFolder& folder, const std::optional<Shard>& shard) {
  ShardFiles all;
  std::vector<std::string> names;
  fs::file_time_type latest = fs::file_time_type::min();
  std::error_code error;
  for (fs::directory_iterator at(folder.shards(), error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    const auto of = shard_of_file(name);
    if (of && (!shard || may_share_points(*of, *shard))) names.push_back(name);
    std::error_code ignored;
    const auto written = at->last_write_time(ignored);
    if (of && !ignored && (!all.latest || written > latest)) all.latest = of, latest = written;
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    all.error = IoError{folder.shards(), error.message()};
    return all;
  }
  std::sort(names.begin(), names.end());
  std::string text;
  for (const std::string& name : names) {
    if ((all.error = read_text_file(folder.shards() / name, text, largest_mesh_text))) return all;
    ShardFile& file = all.files.emplace_back(parse_shard_file(name, text, folder.plan.outputs.size()));
    if (!file.attempt.plan.empty() && file.attempt.plan != folder.hash) {
      all.error = IoError{folder.shards() / name, "has rows of another plan", true};
      return all;
    }
  }
  return all;
}

}  // namespace cloth
