#include <fmt/format.h>
#include <fmt/ranges.h>

#include "commands.h"
#include "studies.h"
#include "study/iterations_report.h"

namespace clothlab::cli {
namespace {

struct IterationsArguments {
  std::string scene;
  std::vector<std::string> settings;
  cloth::IterationsOptions options;
  std::string folder;
  bool overwrite = false;  ///< an unfinished study of other inputs
  bool json = false;
};

std::string command_of(const IterationsArguments& arguments) {
  const cloth::IterationsOptions& options = arguments.options;
  std::string text = "clothlab-cli iterations " + arguments.scene + settings_text(arguments.settings);
  if (!options.methods.empty()) text += fmt::format(" --methods {}", fmt::join(options.methods, ","));
  if (options.step) text += fmt::format(" --step {}", *options.step);
  return text + fmt::format(" --time {} --most {} --out DIR", options.time, options.most);
}

int iterations(const IterationsArguments& arguments) {
  const LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
  if (!loaded.scene) return loaded.exit_code;
  const cloth::Scene& scene = *loaded.scene;
  const cloth::IterationsOptions& options = arguments.options;
  if (const auto problems = find_problems(scene, options); !problems.empty()) return report(problems);
  const auto made = make_study(
      cloth::plan_iterations_study(scene, options), options,
      {arguments.folder, command_of(arguments), arguments.scene, arguments.overwrite},
      [&](const cloth::IterationsOptions& all) { return cloth::run_iterations_study(scene, all); });
  if (const int* failed = std::get_if<int>(&made)) return *failed;
  const cloth::IterationsStudy& study = std::get<0>(made).table;
  std::string text = arguments.json ? study_json(study) : study_text(study);
  if (!arguments.json && !arguments.folder.empty()) text += "results in " + arguments.folder + "\n";
  if (const int printed = print(text); printed != done) return printed;
  if (study.stopped) return interrupted;
  return study.failure.empty() ? done : diverged;
}

}  // namespace

void add_iterations(Program& program) {
  auto [command, arguments] = add_command(
      program, "iterations", "How the iterations of implicit Euler's solvers converge in one step of a scene",
      iterations);
  add_scene(command, arguments.scene)->required();
  add_settings(command, arguments.settings);
  add_names(command, "--methods", arguments.options.methods,
            "Methods, between commas; all that iterate without", cloth::iterated_methods());
  command
      .add_option("--step", arguments.options.step,
                  "The time step in s; without it the scene's, or 0.01 where that is auto")
      ->check(CLI::PositiveNumber);
  command
      .add_option("--time", arguments.options.time,
                  "Simulated time in s before the step that is studied; 0.25 without")
      ->check(CLI::NonNegativeNumber);
  command.add_option("--most", arguments.options.most, "Most iterations; 1000 without")
      ->check(CLI::Range(1, 1000000));
  add_path(command, "--out", arguments.folder,
           "Folder for iterations.csv, iterations.svg, iterations_time.svg, study.json and report.html; made "
           "if missing");
  add_overwrite(command, arguments.overwrite);
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
