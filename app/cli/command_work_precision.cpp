#include <fmt/format.h>
#include <fmt/ranges.h>

#include "commands.h"
#include "integrators/registry.h"
#include "studies.h"
#include "study/work_precision_report.h"

namespace clothlab::cli {
namespace {

struct WorkPrecisionArguments {
  std::string scene;
  std::vector<std::string> settings;
  cloth::WorkPrecisionOptions options;
  std::string folder;
  std::string shard;       ///< that is made alone; empty: all
  bool overwrite = false;  ///< an unfinished study of other inputs
  bool json = false;
};

std::string command_of(const WorkPrecisionArguments& arguments) {
  std::string text = "clothlab-cli work-precision " + arguments.scene + settings_text(arguments.settings);
  if (!arguments.options.methods.empty())
    text += fmt::format(" --methods {}", fmt::join(arguments.options.methods, ","));
  if (arguments.options.horizon) text += fmt::format(" --horizon {}", *arguments.options.horizon);
  if (arguments.options.repeats != cloth::WorkPrecisionOptions{}.repeats)
    text += fmt::format(" --repeats {}", arguments.options.repeats);
  return text + " --out DIR";
}

int work_precision(const WorkPrecisionArguments& arguments) {
  const LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
  if (!loaded.scene) return loaded.exit_code;
  const cloth::Scene& scene = *loaded.scene;
  const auto& methods =
      arguments.options.methods.empty() ? cloth::integrator_names() : arguments.options.methods;
  if (arguments.options.horizon)
    if (const auto rule = cloth::broken_horizon_rule(scene, methods, *arguments.options.horizon))
      return report({{"", "", *rule, fmt::format("--horizon {}", *arguments.options.horizon), 0, 0}});
  if (const int refused = refused_for_memory(scene, methods); refused != done) return refused;

  const cloth::WorkPrecisionOptions& options = arguments.options;
  std::string no_reference;
  const auto made = make_study(
      cloth::plan_work_precision(scene, options), options,
      {arguments.folder, command_of(arguments), arguments.scene, arguments.overwrite, arguments.shard},
      [&](const cloth::WorkPrecisionOptions& all) {
        cloth::WorkPrecision study = cloth::study_work_precision(scene, all);
        if (!study.stopped) no_reference = study.reference.failure;
        return study;
      });
  if (!no_reference.empty()) say("there is no reference: " + no_reference);
  if (const int* ended = std::get_if<int>(&made))
    return *ended == done && !no_reference.empty() ? static_cast<int>(diverged) : *ended;
  const cloth::WorkPrecision& study = std::get<0>(made).table;
  std::string text = arguments.json ? cloth::study_json(study) : cloth::study_text(study);
  if (!arguments.json && !arguments.folder.empty()) text += "results in " + arguments.folder + "\n";
  if (const int printed = print(text); printed != done) return printed;
  if (study.stopped) return interrupted;
  return no_reference.empty() ? done : diverged;
}

}  // namespace

void add_work_precision(Program& program) {
  auto [command, arguments] = add_command(
      program, "work-precision", "Error against run time of every method on a scene", work_precision);
  add_scene(command, arguments.scene)->required();
  add_settings(command, arguments.settings);
  add_names(command, "--methods", arguments.options.methods, "Only these methods, e.g. verlet,rk4",
            cloth::integrator_names());
  command
      .add_option("--horizon", arguments.options.horizon,
                  "Simulated time in s; chosen from the scene if not given")
      ->check(CLI::PositiveNumber);
  command.add_option("--repeats", arguments.options.repeats, "Timed repeats of each run")
      ->check(CLI::Range(5, 1000))
      ->capture_default_str();
  CLI::Option* out = add_path(
      command, "--out", arguments.folder,
      "Folder for work_precision.csv, work_precision_samples.csv, work_precision.svg, study.json and "
      "report.html; made if missing");
  add_shard(command, arguments.shard, out);
  add_overwrite(command, arguments.overwrite);
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
