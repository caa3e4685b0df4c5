#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>

#include "commands.h"
#include "io/result_folder.h"
#include "progress.h"
#include "studies.h"
#include "study/iterations_report.h"

namespace clothlab::cli {
namespace {

struct IterationsArguments {
  std::string scene;
  std::vector<std::string> settings;
  cloth::IterationsOptions options;
  std::string folder;
  bool json = false;
};

constexpr const char *csv_name = "iterations.csv", *plot_name = "iterations.svg",
                     *time_plot_name = "iterations_time.svg", *index_name = "iterations.json";

std::string command_of(const IterationsArguments& arguments) {
  const cloth::IterationsOptions& options = arguments.options;
  std::string text = "clothlab-cli iterations " + arguments.scene + settings_text(arguments.settings);
  if (!options.methods.empty()) text += fmt::format(" --methods {}", fmt::join(options.methods, ","));
  if (options.step) text += fmt::format(" --step {}", *options.step);
  return text + fmt::format(" --time {} --most {} --out DIR", options.time, options.most);
}

std::optional<cloth::IoError> write_folder(cloth::ResultFolder& folder, const cloth::IterationsStudy& study,
                                           const std::string& command, double wall) {
  if (auto error = folder.write(csv_name, cloth::csv_text(table_of(study), "\r\n"), true)) return error;
  if (auto error = folder.write(plot_name, to_svg(study_plot(study, cloth::IterationsAgainst::iterations))))
    return error;
  if (auto error = folder.write(time_plot_name, to_svg(study_plot(study, cloth::IterationsAgainst::time))))
    return error;
  if (auto error = folder.write("report.html", study_page(study, command, wall))) return error;
  return folder.finish(index_name, study_index(study, command, wall, folder.digests()));
}

int iterations(const IterationsArguments& arguments) {
  const LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
  if (!loaded.scene) return loaded.exit_code;
  cloth::IterationsOptions options = arguments.options;
  if (const auto problems = find_problems(*loaded.scene, options); !problems.empty()) return report(problems);
  listen_for_stop();
  cloth::ResultFolder folder;
  if (!arguments.folder.empty()) {
    std::vector<std::filesystem::path> inputs;
    if (std::filesystem::is_regular_file(arguments.scene)) inputs.emplace_back(arguments.scene);
    if (const auto error = folder.claim(
            arguments.folder, {.kind = "iterations",
                               .files = {csv_name, plot_name, time_plot_name, "report.html", index_name},
                               .inputs = inputs}))
      return report(*error);
  }
  const auto start = std::chrono::steady_clock::now();
  cloth::IterationsStudy study;
  {
    Progress bar;
    options.stop = stop_is_requested;
    options.progress = [&](const cloth::StudyProgress& progress) {
      bar.show(progress.fraction, progress.text);
      return !stop_is_requested();
    };
    study = run_iterations_study(*loaded.scene, options);
  }
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (folder.is_open())
    if (const auto error = write_folder(folder, study, command_of(arguments), wall)) return report(*error);
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
  add_path(
      command, "--out", arguments.folder,
      "Folder for iterations.csv, iterations.svg, iterations_time.svg, iterations.json and report.html; made "
      "if missing");
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
