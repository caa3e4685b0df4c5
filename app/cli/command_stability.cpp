#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "commands.h"
#include "integrators/registry.h"
#include "studies.h"
#include "study/stability_report.h"

namespace clothlab::cli {
namespace {

struct StabilityArguments {
  std::string scene;
  std::vector<std::string> settings;
  std::string x, y;                 ///< PATH=LOW:HIGH:COUNT[:log]; empty: time step over stiffness
  cloth::StabilityOptions options;  ///< without axes; no methods: those with a limit
  std::string folder;
  std::string shard;       ///< that is made alone; empty: all
  int jobs = 0;            ///< 0: all cores
  bool overwrite = false;  ///< an unfinished study of other inputs
  bool json = false;
};

/// Fills in axes and methods, or says what is wrong with them.
std::vector<cloth::Problem> read_options(const StabilityArguments& arguments, const cloth::Scene& scene,
                                         cloth::StabilityOptions& options) {
  const std::vector<std::string>& asked = arguments.options.methods;
  options.methods.clear();
  for (const std::string& method : asked.empty() ? cloth::methods_with_a_limit() : asked)
    if (std::find(options.methods.begin(), options.methods.end(), method) == options.methods.end())
      options.methods.push_back(method);
  std::vector<cloth::Problem> problems;
  const auto read_axis = [&](const std::string& text, const char* option, cloth::StudyAxis& axis) {
    const auto parsed = cloth::parse_axis(text, option);
    if (const auto* problem = std::get_if<cloth::Problem>(&parsed))
      problems.push_back(*problem);
    else
      axis = std::get<cloth::StudyAxis>(parsed);
  };
  options.x = cloth::default_time_axis(scene, options.methods);
  options.y = cloth::default_stiffness_axis(scene);
  if (!arguments.x.empty()) read_axis(arguments.x, "--x", options.x);
  if (!arguments.y.empty()) read_axis(arguments.y, "--y", options.y);
  return problems.empty() ? cloth::find_problems(scene, options) : problems;
}

std::string command_text(const StabilityArguments& arguments) {
  std::string text = "clothlab-cli stability " + arguments.scene + settings_text(arguments.settings);
  if (!arguments.x.empty()) text += " --x '" + arguments.x + "'";
  if (!arguments.y.empty()) text += " --y '" + arguments.y + "'";
  if (!arguments.options.methods.empty())
    text += fmt::format(" --methods {}", fmt::join(arguments.options.methods, ","));
  if (arguments.options.criterion.periods != cloth::StabilityCriterion{}.periods)
    text += fmt::format(" --periods {}", arguments.options.criterion.periods);
  if (arguments.options.criterion.max_steps != cloth::StabilityCriterion{}.max_steps)
    text += fmt::format(" --most-steps {}", arguments.options.criterion.max_steps);
  if (arguments.options.full_size) text += " --full-size";
  return text + " --out DIR";
}

int stability(const StabilityArguments& arguments) {
  const LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
  if (!loaded.scene) return loaded.exit_code;
  cloth::StabilityOptions options = arguments.options;
  options.jobs = chosen_jobs(arguments.jobs);
  const auto problems = read_options(arguments, *loaded.scene, options);
  if (!problems.empty()) return report(problems);
  if (options.full_size)
    if (const int refused = refused_for_memory(*loaded.scene, options.methods); refused != done)
      return refused;

  const cloth::Scene& scene = *loaded.scene;
  const auto made = make_study(
      cloth::plan_stability_map(scene, options), options,
      {arguments.folder, command_text(arguments), arguments.scene, arguments.overwrite, arguments.shard},
      [&](const cloth::StabilityOptions& all) { return cloth::run_stability_map(scene, all); });
  if (const int* failed = std::get_if<int>(&made)) return *failed;
  const auto& [map, wall] = std::get<0>(made);
  const int printed = print(arguments.json ? cloth::study_json(map)
                                           : cloth::study_text(map) + fmt::format("{:.3g} s; results in {}\n",
                                                                                  wall, arguments.folder));
  if (printed != done) return printed;
  return map.complete ? done : interrupted;
}

}  // namespace

void add_stability(Program& program) {
  auto [command, arguments] = add_command(
      program, "stability",
      "Map where each method is stable over two parameters, with the predicted limits over it", stability);
  add_scene(command, arguments.scene)->required();
  add_settings(command, arguments.settings);
  command.add_option("--x", arguments.x,
                     "PATH=LOW:HIGH:COUNT or PATH=LOW:HIGH:COUNT:log; without it the time step around the "
                     "predicted limits");
  command.add_option("--y", arguments.y,
                     "Likewise; without it springs.*, all stiffnesses together, a tenth to ten times the "
                     "scene's. springs.* is the structural stiffness, shear and flexion in proportion");
  add_names(command, "--methods", arguments.options.methods,
            "Methods, separated by commas; without it all that have a limit", cloth::integrator_names());
  command
      .add_option("--periods", arguments.options.criterion.periods,
                  "Length of a run in periods of the fastest motion")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  command
      .add_option("--most-steps", arguments.options.criterion.max_steps,
                  "After so many steps a run ends, however long it should last")
      ->check(CLI::Range(1, 100000000))
      ->capture_default_str();
  command.add_flag("--full-size", arguments.options.full_size,
                   "Run the whole grid; without it larger ones are run with 16 x 16 of the same particles");
  CLI::Option* out =
      add_path(command, "--out", arguments.folder,
               "Folder for stability.csv, stability.svg, study.json and report.html; made if missing");
  add_shard(command, arguments.shard, out->required());
  add_jobs(command, arguments.jobs, "Cells that are run at once, fewer where memory is short");
  add_overwrite(command, arguments.overwrite);
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
