#include "sweep_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "console.h"
#include "progress.h"
#include "sweep/emit_sweep.h"
#include "sweep/merge_sweep.h"
#include "sweep/run_sweep.h"
#include "sweep/sweep_points.h"

namespace clothlab::cli {
namespace {

constexpr std::int64_t most_shards = 100'000'000;

/// Snakemake looks at all jobs again and again: thousands stall it.
constexpr std::int64_t most_snakemake_jobs = 1000;

struct StatusArguments {
  std::string folder;
  bool missing = false, json = false;
  std::int64_t shards = 0;  ///< 0: as the latest attempt had it
  std::int64_t after = 0, at_most = most_shards;
};

/// A folder and what its shard files say, or the exit code after a message.
struct LoadedSweep {
  std::optional<cloth::SweepFolder> folder;
  cloth::SweepResults results{};
  cloth::Shard latest{};  ///< of the attempts
  int exit_code = done;
};

LoadedSweep load_sweep(const std::string& path) {
  cloth::SweepFolderReading reading = cloth::read_sweep_folder(path);
  if (!reading.folder)
    return {.folder = std::nullopt,
            .exit_code = reading.error ? report(*reading.error) : report(reading.problems)};
  const cloth::ShardFiles files = cloth::read_shard_files(*reading.folder);
  if (files.error) return {.folder = std::nullopt, .exit_code = report(*files.error)};
  auto results = cloth::sweep_results(*reading.folder, files.files);
  return {std::move(reading.folder), std::move(results), files.latest.value_or(cloth::Shard{}), done};
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

int print_missing(const StatusArguments& arguments, const LoadedSweep& sweep) {
  const std::int64_t count = arguments.shards > 0 ? arguments.shards : sweep.latest.count;
  const std::string text = cloth::missing_shards(sweep.results, count, arguments.after, arguments.at_most);
  return text.empty() ? done : print(text + "\n");
}

int status(const StatusArguments& arguments) {
  const LoadedSweep sweep = load_sweep(arguments.folder);
  if (!sweep.folder) return sweep.exit_code;
  if (arguments.missing) return print_missing(arguments, sweep);
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

// --- emit ---

struct EmitArguments {
  std::string folder, plan, target;
  cloth::EmitOptions options{.shards = 0, .program = {}};
  double minutes = 10;  ///< of a task
};

/// s of a point: the mean of those that are there, else of the first one, which is run for it.
std::variant<double, int> seconds_of_a_point(const cloth::SweepFolder& folder) {
  for (const bool is_run : {false, true}) {
    const cloth::ShardFiles files = cloth::read_shard_files(folder);
    if (files.error) return report(*files.error);
    double wall = 0;
    std::int64_t count = 0;
    for (const cloth::ShardFile& file : files.files)
      for (const cloth::PointRow& row : file.rows) wall += row.wall, ++count;
    if (count > 0) return wall / static_cast<double>(count);
    if (is_run) break;
    listen_for_stop();
    const cloth::SweepRun first =
        cloth::run_sweep(folder, {.shard = {1, cloth::point_count(folder.plan)}, .stop = stop_is_requested});
    if (first.error) return report(*first.error);
    if (first.stopped) return interrupted;
  }
  return 0.0;
}

int write_files(const cloth::SweepFolder& folder, const std::vector<cloth::EmittedFile>& files) {
  for (const cloth::EmittedFile& file : files) {
    const std::filesystem::path path = folder.path / file.name;
    if (const auto error = cloth::make_folder(path.parent_path())) return report(*error);
    if (const auto error = cloth::write_text_file(path, file.text)) return report(*error);
    std::error_code ignored;
    if (file.is_program)
      std::filesystem::permissions(path,
                                   std::filesystem::perms::owner_exec | std::filesystem::perms::group_exec,
                                   std::filesystem::perm_options::add, ignored);
  }
  // Slurm does not make the folder of its logs, and says nothing.
  if (const auto error = cloth::make_folder((folder.path / files.front().name).parent_path() / "log"))
    return report(*error);
  return done;
}

int emit(const EmitArguments& arguments) {
  const TakenFolder taken = take_folder(arguments.plan, arguments.folder);
  if (!taken.folder) return taken.exit_code;
  cloth::SweepFolder folder = *taken.folder;
  std::error_code error;
  folder.path = std::filesystem::canonical(folder.path, error);
  cloth::EmitOptions options = arguments.options;
  const auto& names = cloth::emit_target_names();
  options.target =
      static_cast<cloth::EmitTarget>(std::find(names.begin(), names.end(), arguments.target) - names.begin());
  if (options.program.empty())
    options.program = std::filesystem::read_symlink("/proc/self/exe", error).string();
  if (options.shards == 0) {
    const auto seconds = seconds_of_a_point(folder);
    if (const int* failed = std::get_if<int>(&seconds)) return *failed;
    options.shards = cloth::packed_shards(cloth::point_count(folder.plan), std::get<double>(seconds),
                                          options.jobs, 60 * arguments.minutes);
    if (options.target == cloth::EmitTarget::snakemake)
      options.shards = std::min<std::int64_t>(options.shards, most_snakemake_jobs);
    say(fmt::format("a point takes {:.3g} s: {} shards", std::get<double>(seconds), options.shards));
  }
  const auto files = cloth::emitted_files(folder, options);
  if (const int written = write_files(folder, files); written != done) return written;
  std::string text;
  for (const cloth::EmittedFile& file : files) text += (folder.path / file.name).string() + "\n";
  return print(text);
}

template <class Arguments>
CLI::App& add_one(Program& program, CLI::App& sweep, const char* name, const char* help,
                  const std::shared_ptr<Arguments>& arguments, int (*run)(const Arguments&)) {
  CLI::App* command = sweep.add_subcommand(name, help);
  command->add_option("folder", arguments->folder, "Folder of a sweep")->required();
  command->callback([&program, arguments, run] { program.chosen = [=] { return run(*arguments); }; });
  return *command;
}

void add_emit(Program& program, CLI::App& sweep) {
  const auto arguments = std::make_shared<EmitArguments>();
  CLI::App& command =
      add_one(program, sweep, "emit", "Write the scripts by which a scheduler runs a sweep's shards",
              arguments, emit);
  command.add_option("--for", arguments->target, "slurm, parallel or snakemake")
      ->required()
      ->check(CLI::IsMember(cloth::emit_target_names()));
  add_path(command, "--plan", arguments->plan, "Make the folder for this plan first");
  command
      .add_option("--shards", arguments->options.shards,
                  "Parts of the sweep; without it as many as take about --minutes each")
      ->check(CLI::Range(std::int64_t{1}, most_shards));
  command
      .add_option("--minutes", arguments->minutes,
                  "How long a task should take, by the time of a first point, which is run for it")
      ->check(CLI::Range(0.01, 1e5))
      ->capture_default_str();
  command.add_option("--at-once", arguments->options.at_once, "Tasks that may run at the same time")
      ->check(CLI::Range(1, 1'000'000));
  command
      .add_option("--jobs", arguments->options.jobs, "Points at once within a task, on as many processors")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  add_path(command, "--program", arguments->options.program,
           "clothlab-cli as the nodes see it; without it this one");
}

}  // namespace

TakenFolder take_folder(const std::string& plan_file, const std::string& folder) {
  cloth::SweepFolderReading taken;
  if (plan_file.empty()) {
    taken = cloth::resume_sweep_folder(folder);
  } else {
    std::string text;
    if (const auto error = cloth::read_text_file(plan_file, text)) return {std::nullopt, report(*error)};
    const cloth::SweepReading reading = cloth::read_sweep(text, plan_file);
    if (!reading.plan) return {std::nullopt, report(reading.problems)};
    if (auto problem = cloth::unknown_output(*reading.plan)) {
      problem->place = plan_file;
      return {std::nullopt, report(std::vector<cloth::Problem>{*problem})};
    }
    taken = cloth::take_sweep_folder(folder, *reading.plan);
  }
  if (taken.error) return {std::nullopt, report(*taken.error)};
  if (!taken.folder) return {std::nullopt, report(taken.problems)};
  return {std::move(taken.folder), done};
}

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
      .add_option("--shards", of_status->shards,
                  "Of how many shards; without it as many as the latest attempt had")
      ->check(CLI::Range(std::int64_t{1}, most_shards));
  status_command
      .add_option("--after", of_status->after,
                  "Of the shards behind this one, counted from it on: an array's offset")
      ->check(CLI::Range(std::int64_t{0}, most_shards));
  status_command.add_option("--at-most", of_status->at_most, "Of so many shards from there on")
      ->check(CLI::Range(std::int64_t{1}, most_shards));
  add_json(status_command, of_status->json);
  add_one(program, sweep, "merge", "Write sweep.csv, plots and report.html of all points that are there",
          std::make_shared<MergeArguments>(), merge);
  add_emit(program, sweep);
}

}  // namespace clothlab::cli
