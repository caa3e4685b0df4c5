#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "commands.h"
#include "console.h"
#include "integrators/registry.h"
#include "io/run_folder.h"
#include "progress.h"
#include "studies.h"
#include "study/study_recorder.h"
#include "study/work_precision_tables.h"

namespace clothlab::cli {
namespace {

/// True if every method is known; says which are otherwise.
bool are_known(const std::vector<std::string>& methods) {
  const auto& names = cloth::integrator_names();
  for (const std::string& method : methods)
    if (std::find(names.begin(), names.end(), method) == names.end()) {
      say(fmt::format("--methods: \"{}\" is not a method; known are {}", method, fmt::join(names, ", ")));
      return false;
    }
  return true;
}

std::string command_of(const WorkPrecisionArguments& arguments) {
  std::string text = "clothlab-cli work-precision " + arguments.scene;
  for (const std::string& setting : arguments.settings) text += " --set '" + setting + "'";
  if (!arguments.methods.empty()) text += fmt::format(" --methods {}", fmt::join(arguments.methods, ","));
  if (arguments.horizon) text += fmt::format(" --horizon {}", *arguments.horizon);
  if (arguments.repeats != WorkPrecisionArguments{}.repeats)
    text += fmt::format(" --repeats {}", arguments.repeats);
  return text + " --out DIR";
}

}  // namespace

int work_precision(const WorkPrecisionArguments& arguments) {
  if (!are_known(arguments.methods)) return bad_input;
  const LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
  if (!loaded.scene) return loaded.exit_code;

  const auto& methods = arguments.methods.empty() ? cloth::integrator_names() : arguments.methods;
  if (arguments.horizon)
    if (const auto rule = cloth::broken_horizon_rule(*loaded.scene, methods, *arguments.horizon))
      return report({{"", "", *rule, fmt::format("--horizon {}", *arguments.horizon), 0, 0}});
  if (const int refused = refused_for_memory(*loaded.scene, methods); refused != done) return refused;

  listen_for_stop();
  cloth::WorkPrecisionOptions options;
  options.methods = arguments.methods;
  options.horizon = arguments.horizon;
  options.repeats = arguments.repeats;
  cloth::StudyRecorder recorder;
  std::optional<cloth::IoError> failure;
  if (!arguments.folder.empty()) {
    const cloth::StudyTable plan = cloth::plan_work_precision(*loaded.scene, options);
    failure = recorder.begin(arguments.folder, plan,
                             {command_of(arguments), {arguments.scene}, arguments.overwrite});
    if (failure) return report(*failure);
    say_what_goes_on(recorder);
    if (recorder.earlier()) options.earlier = &std::get<cloth::WorkPrecision>(*recorder.earlier());
    options.partial = [&](const cloth::WorkPrecision& so_far) {
      if (!failure) failure = recorder.keep(so_far);
    };
  }
  const auto start = std::chrono::steady_clock::now();
  cloth::WorkPrecision study;
  {
    Progress bar;
    options.progress = [&](const cloth::StudyProgress& progress) {
      bar.show(progress.fraction, progress.text);
      return !failure && !stop_is_requested();
    };
    study = cloth::study_work_precision(*loaded.scene, options);
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  if (!failure && recorder.is_open()) failure = recorder.end(study, wall.count());
  if (failure) return report(*failure);
  const bool has_reference = study.reference.failure.empty();
  if (!has_reference && !study.stopped) say("there is no reference: " + study.reference.failure);
  std::string text = arguments.json ? cloth::work_precision_json(study) : cloth::work_precision_text(study);
  if (!arguments.json && !arguments.folder.empty()) text += "results in " + arguments.folder + "\n";
  if (const int printed = print(text); printed != done) return printed;
  if (study.stopped) return interrupted;
  return has_reference ? done : diverged;
}

}  // namespace clothlab::cli
