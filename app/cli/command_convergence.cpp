#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "commands.h"
#include "simulation/step_batches.h"
#include "studies.h"
#include "study/grid_convergence_report.h"

namespace clothlab::cli {
namespace {

struct ConvergenceArguments {
  std::string scene;
  std::vector<std::string> settings;
  cloth::GridConvergenceOptions options;  ///< cells, outputs, time
  int threads = 0;                        ///< 0: as many as the machine has
  std::string folder;
  std::string shard;       ///< that is made alone; empty: all
  bool overwrite = false;  ///< an unfinished study of other inputs
  bool json = false;
};

std::string command_of(const ConvergenceArguments& arguments) {
  const cloth::GridConvergenceOptions& options = arguments.options;
  std::string text = "clothlab-cli convergence " + arguments.scene + settings_text(arguments.settings);
  if (!options.cells.empty()) text += fmt::format(" --cells {}", fmt::join(options.cells, ","));
  if (!options.outputs.empty()) text += fmt::format(" --output {}", fmt::join(options.outputs, ","));
  if (options.time) text += fmt::format(" --time {}", *options.time);
  return text + " --out DIR";
}

/// Whether any output has values to compare.
bool has_comparison(const cloth::GridConvergence& study) {
  for (std::size_t k = 0; k < study.outputs.size(); ++k)
    if (grid_values(study, k, study.runs.size()).size() >= 2) return true;
  return false;
}

int convergence(const ConvergenceArguments& arguments) {
  const LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
  if (!loaded.scene) return loaded.exit_code;
  const cloth::Scene& scene = *loaded.scene;
  cloth::GridConvergenceOptions options = arguments.options;
  options.threads = arguments.threads > 0 ? arguments.threads : cloth::machine_threads();
  if (const auto problems = cloth::find_problems(scene, options); !problems.empty()) return report(problems);

  const auto made = make_study(
      cloth::plan_grid_convergence(scene, options), options,
      {arguments.folder, command_of(arguments), arguments.scene, arguments.overwrite, arguments.shard},
      [&](const cloth::GridConvergenceOptions& all) { return cloth::run_grid_convergence(scene, all); });
  if (const int* failed = std::get_if<int>(&made)) return *failed;
  const cloth::GridConvergence& study = std::get<0>(made).table;
  std::string text = arguments.json ? cloth::study_json(study) : cloth::study_text(study);
  if (!arguments.json && !arguments.folder.empty()) text += "results in " + arguments.folder + "\n";
  if (const int printed = print(text); printed != done) return printed;
  if (!study.is_complete()) return interrupted;
  if (has_comparison(study)) return done;
  say("no two grids have a value");
  return diverged;
}

}  // namespace

void add_convergence(Program& program) {
  auto [command, arguments] =
      add_command(program, "convergence",
                  "Outputs of a scene on finer and finer grids, and what they converge to", convergence);
  add_scene(command, arguments.scene)->required();
  add_settings(command, arguments.settings);
  command
      .add_option("--cells", arguments.options.cells,
                  "Cells across of each grid, from coarse to fine, e.g. 8,16,32,64; chosen from the scene if "
                  "not given. The cells down follow in the scene's proportion")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      .add_option("--output", arguments.options.outputs,
                  "What to read off, between commas: columns of record.csv, lowest_point, sag or "
                  "droop_ratio; at the end, or with :max, :min or :mean over all rows, e.g. max_strain:max. "
                  "Without it lowest_point,elastic_J")
      ->delimiter(',')
      ->allow_extra_args(false);
  command
      .add_option("--time", arguments.options.time, "Simulated time in s; the scene's duration if not given")
      ->check(CLI::PositiveNumber);
  command
      .add_option("--threads", arguments.threads,
                  "Threads that a step may use; without it all cores. The results are the same to the bit")
      ->check(CLI::Range(1, 1024));
  CLI::Option* out = add_path(
      command, "--out", arguments.folder,
      "Folder for convergence.csv, convergence.svg, convergence_error.svg, study.json and report.html; "
      "made if missing");
  add_shard(command, arguments.shard, out);
  add_overwrite(command, arguments.overwrite);
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
