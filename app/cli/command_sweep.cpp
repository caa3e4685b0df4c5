#include <fmt/format.h>

#include <thread>

#include "commands.h"
#include "console.h"
#include "progress.h"
#include "sweep/run_sweep.h"
#include "sweep_commands.h"

namespace clothlab::cli {
namespace {

struct SweepArguments {
  std::string plan, folder;
  std::string shard;  ///< empty: all
  int jobs = 0;       ///< 0: all cores
  int stopped_exit_code = interrupted;
};

/// Runs that are asked to stop may be within a step that takes long. Their rows are lost in any case, and
/// those of other points are written: so the process ends in time for a scheduler that kills it soon after.
void end_in_time(int exit_code) {
  std::thread([exit_code] {
    while (!stop_is_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    std::_Exit(exit_code);
  }).detach();
}

std::string text_of(const cloth::SweepRun& run, const SweepArguments& arguments, const cloth::Shard& shard) {
  std::string text = fmt::format("{} of {} points", run.earlier + run.made, run.points);
  if (shard.count > 1) text += fmt::format(" of shard {}/{}", shard.index, shard.count);
  if (run.earlier > 0) text += fmt::format(", {} of them made before", run.earlier);
  return text + fmt::format("; rows in {}/{}\n", arguments.folder, cloth::shard_folder_name);
}

int run_shard(const cloth::SweepFolder& folder, const SweepArguments& arguments, const cloth::Shard& shard) {
  listen_for_stop();
  end_in_time(arguments.stopped_exit_code);
  cloth::SweepRun run;
  {
    Progress bar;
    cloth::SweepRunOptions options{
        .jobs = chosen_jobs(arguments.jobs), .shard = shard, .stop = stop_is_requested};
    options.progress = [&](std::int64_t there, std::int64_t of) {
      bar.show(static_cast<double>(there) / static_cast<double>(of),
               fmt::format("{} of {} points", there, of));
    };
    run = cloth::run_sweep(folder, options);
  }
  if (run.error) return report(*run.error);
  if (run.stopped) {
    say(fmt::format("stopped with {} of {} points; the same command goes on", run.earlier + run.made,
                    run.points));
    return arguments.stopped_exit_code;
  }
  return print(text_of(run, arguments, shard));
}

int sweep(const SweepArguments& arguments) {
  const auto chosen = chosen_shard(arguments.shard);
  if (const int* failed = std::get_if<int>(&chosen)) return *failed;
  const cloth::Shard shard = std::get<0>(chosen).value_or(cloth::Shard{});
  const TakenFolder taken = take_folder(arguments.plan, arguments.folder);
  if (!taken.folder) return taken.exit_code;
  const int ended = run_shard(*taken.folder, arguments, shard);
  if (ended != done || shard.count > 1) return ended;
  return merge_folder(*taken.folder);
}

}  // namespace

void add_sweep(Program& program) {
  const auto arguments = std::make_shared<SweepArguments>();
  CLI::App* command = program.app.add_subcommand(
      "sweep", "Run a scene at many points of its parameters; goes on where it was stopped");
  command->add_option("plan", arguments->plan,
                      "A plan, *.sweep.json; without it that of the folder, which goes on");
  add_path(*command, "--out", arguments->folder, "Folder of the sweep; made if missing");
  add_path(
      *command, "--shard", arguments->shard,
      "I/N: the points p with p mod N = I - 1 alone. auto/N takes I from the environment of an array job "
      "(Slurm, PBS, SGE, LSF), auto takes both, auto+OFFSET/N adds to I");
  add_jobs(*command, arguments->jobs, "Points that are run at once");
  command
      ->add_option("--stopped-exit-code", arguments->stopped_exit_code,
                   "Exit code after Ctrl+C or SIGTERM, with every finished point on disk")
      ->check(CLI::Range(0, 255))
      ->capture_default_str();
  add_sweep_commands(program, *command);
  command->callback([&program, command, arguments] {
    if (!command->get_subcommands().empty()) return;
    if (arguments->folder.empty()) throw CLI::RequiredError("--out");
    program.chosen = [arguments] { return sweep(*arguments); };
  });
}

}  // namespace clothlab::cli
