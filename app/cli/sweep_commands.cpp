#include "sweep_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "console.h"
#include "sweep/merge_sweep.h"

namespace clothlab::cli {
namespace {

struct StatusArguments {
  std::string folder;
  bool missing = false, json = false;
  std::int64_t shards = 0;  ///< 0: as the attempts had it
};

/// A folder and what its shard files say, or the exit code after a message.
struct LoadedSweep {
  std::optional<cloth::SweepFolder> folder;
  cloth::SweepResults results;
  int exit_code = done;
};

LoadedSweep load_sweep(const std::string& path) {
  cloth::SweepFolderReading reading = cloth::read_sweep_folder(path);
  if (!reading.folder)
    return {std::nullopt, {}, reading.error ? report(*reading.error) : report(reading.problems)};
  const cloth::ShardFiles files = cloth::read_shard_files(*reading.folder);
  if (files.error) return {std::nullopt, {}, report(*files.error)};
  auto results = cloth::sweep_results(*reading.folder, files.files);
  return {std::move(reading.folder), std::move(results), done};
}

std::string counts_text(const cloth::SweepResults& results) {
  std::string text = fmt::format("{} points:", results.points);
  for (int k = 0; k < cloth::point_statuses; ++k)
    if (const auto count = results.counts[static_cast<std::size_t>(k)]; count > 0)
      text += fmt::format(" {} {},", count, cloth::name_of(static_cast<cloth::PointStatus>(k)));
  return text + fmt::format(" {} missing\n", results.missing());
}

std::string status_json(const cloth::SweepResults& results) {
  nlohmann::ordered_json root{{"points", results.points}};
  for (int k = 0; k < cloth::point_statuses; ++k)
    root["status"][cloth::name_of(static_cast<cloth::PointStatus>(k))] =
        results.counts[static_cast<std::size_t>(k)];
  root["missing"] = results.missing();
  root["attempts"] = results.attempts;
  root["made_twice"] = results.twice;
  root["damaged_lines"] = results.damaged;
  root["disagreements"] = nlohmann::ordered_json::array();
  for (const auto& one : results.disagreements) root["disagreements"].push_back(one.text);
  return root.dump(2) + "\n";
}

int print_missing(const StatusArguments& arguments, const cloth::SweepResults& results) {
  std::int64_t count = arguments.shards;
  for (const cloth::Shard& shard : results.shards) {
    if (arguments.shards > 0) break;
    if (count > 0 && count != shard.count) {
      say("the attempts had different numbers of shards: give --shards N");
      return bad_input;
    }
    count = shard.count;
  }
  const std::string text = cloth::missing_shards(results, std::max<std::int64_t>(1, count));
  return text.empty() ? done : print(text + "\n");
}

int status(const StatusArguments& arguments) {
  const LoadedSweep sweep = load_sweep(arguments.folder);
  if (!sweep.folder) return sweep.exit_code;
  if (arguments.missing) return print_missing(arguments, sweep.results);
  if (arguments.json) return print(status_json(sweep.results));
  std::string text = counts_text(sweep.results);
  text += fmt::format("{} attempts, {} points made twice\n", sweep.results.attempts, sweep.results.twice);
  if (sweep.results.damaged > 0)
    text += fmt::format("{} lines are no rows, and their points count as missing\n", sweep.results.damaged);
  return print(text);
}

int merge_results(const cloth::SweepFolder& folder, const cloth::SweepResults& results) {
  if (!results.disagreements.empty()) {
    for (const auto& one : results.disagreements) say(one.text);
    say(fmt::format("{}: nothing is merged: see the points above", folder.path.string()));
    return differs;
  }
  if (const auto error = cloth::write_merged(folder, results)) return report(*error);
  if (results.missing() > 0)
    say(fmt::format("{} of {} points are missing", results.missing(), results.points));
  return print(counts_text(results) + fmt::format("merged in {}\n", (folder.path / "sweep.csv").string()));
}

struct MergeArguments {
  std::string folder;
};

int merge(const MergeArguments& arguments) {
  const LoadedSweep sweep = load_sweep(arguments.folder);
  return sweep.folder ? merge_results(*sweep.folder, sweep.results) : sweep.exit_code;
}

template <class Arguments>
CLI::App& add_one(Program& program, CLI::App& sweep, const char* name, const char* help,
                  const std::shared_ptr<Arguments>& arguments, int (*run)(const Arguments&)) {
  CLI::App* command = sweep.add_subcommand(name, help);
  command->add_option("folder", arguments->folder, "Folder of a sweep")->required();
  command->callback([&program, arguments, run] { program.chosen = [=] { return run(*arguments); }; });
  return *command;
}

}  // namespace

int merge_folder(const cloth::SweepFolder& folder) {
  const cloth::ShardFiles files = cloth::read_shard_files(folder);
  if (files.error) return report(*files.error);
  return merge_results(folder, cloth::sweep_results(folder, files.files));
}

void add_sweep_commands(Program& program, CLI::App& sweep) {
  const auto of_status = std::make_shared<StatusArguments>();
  CLI::App& status_command =
      add_one(program, sweep, "status", "Count a sweep's points by their status", of_status, status);
  status_command.add_flag("--missing", of_status->missing,
                          "Print the shards with missing points alone, as --array takes them: 3,7-9");
  status_command
      .add_option("--shards", of_status->shards, "Of how many shards; without it as many as the attempts had")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{100'000'000}));
  add_json(status_command, of_status->json);
  add_one(program, sweep, "merge", "Write sweep.csv, plots and report.html of all points that are there",
          std::make_shared<MergeArguments>(), merge);
}

}  // namespace clothlab::cli
