#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "commands.h"
#include "console.h"
#include "integrators/registry.h"
#include "io/run_folder.h"
#include "progress.h"
#include "studies.h"
#include "study/stability_report.h"
#include "study/study_recorder.h"

namespace clothlab::cli {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Fills in axes and methods, or says what is wrong with them.
std::vector<cloth::Problem> read_options(const StabilityArguments& arguments, const cloth::Scene& scene,
                                         cloth::StabilityOptions& options) {
  options.methods = arguments.methods.empty() ? cloth::methods_with_a_limit() : arguments.methods;
  options.criterion.periods = arguments.periods;
  options.criterion.most_steps = arguments.most_steps;
  options.full_size = arguments.full_size;
  std::vector<cloth::Problem> problems;
  std::vector<std::string> known;
  for (const std::string& method : options.methods) {
    const auto& names = cloth::integrator_names();
    if (std::find(names.begin(), names.end(), method) == names.end())
      problems.push_back({.path = {},
                          .value = {},
                          .rule = fmt::format("{}: must be one of {}", method, fmt::join(names, ", ")),
                          .place = "--methods"});
    else if (std::find(known.begin(), known.end(), method) == known.end())
      known.push_back(method);
  }
  options.methods = known;
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
  std::string text = "clothlab-cli stability " + arguments.scene;
  for (const std::string& setting : arguments.settings) text += " --set '" + setting + "'";
  if (!arguments.x.empty()) text += " --x '" + arguments.x + "'";
  if (!arguments.y.empty()) text += " --y '" + arguments.y + "'";
  if (!arguments.methods.empty()) text += fmt::format(" --methods {}", fmt::join(arguments.methods, ","));
  if (arguments.periods != StabilityArguments{}.periods)
    text += fmt::format(" --periods {}", arguments.periods);
  if (arguments.most_steps != StabilityArguments{}.most_steps)
    text += fmt::format(" --most-steps {}", arguments.most_steps);
  if (arguments.full_size) text += " --full-size";
  return text + " --out DIR";
}

}  // namespace

int stability(const StabilityArguments& arguments) {
  const LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
  if (!loaded.scene) return loaded.exit_code;
  cloth::StabilityOptions options;
  const auto problems = read_options(arguments, *loaded.scene, options);
  if (!problems.empty()) return report(problems);
  if (options.full_size)
    if (const int refused = refused_for_memory(*loaded.scene, options.methods); refused != done)
      return refused;

  listen_for_stop();
  cloth::StudyRecorder recorder;
  const cloth::StudyTable plan = cloth::plan_stability_map(*loaded.scene, options);
  const std::string command = command_text(arguments);
  if (const auto error =
          recorder.begin(arguments.folder, plan, {command, {arguments.scene}, arguments.overwrite}))
    return report(*error);
  say_what_goes_on(recorder);

  const auto start = std::chrono::steady_clock::now();
  cloth::StabilityMap map;
  std::optional<cloth::IoError> failure;
  {
    Progress progress;
    if (recorder.earlier()) options.earlier = &std::get<cloth::StabilityMap>(*recorder.earlier());
    options.partial = [&](const cloth::StabilityMap& so_far) {
      if (!failure) failure = recorder.keep(so_far);
    };
    options.progress = [&](double part) {
      progress.show(part, "stability map");
      return !failure && !stop_is_requested();
    };
    map = cloth::run_stability_map(*loaded.scene, options);
  }
  const double wall = seconds_since(start);
  if (!failure) failure = recorder.end(map, wall);
  if (failure) return report(*failure);
  const int printed =
      print(arguments.json ? cloth::stability_json(map)
                           : cloth::stability_text(map) +
                                 fmt::format("{:.3g} s; results in {}\n", wall, arguments.folder));
  if (printed != done) return printed;
  return map.complete ? done : interrupted;
}

}  // namespace clothlab::cli
