#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "commands.h"
#include "integrators/registry.h"
#include "studies.h"
#include "study/extremes_report.h"

namespace clothlab::cli {
namespace {

struct ExtremesArguments {
  std::string scene;  ///< to push; empty: the fixed list
  std::vector<std::string> settings;
  cloth::ExtremesOptions options;  ///< methods and cases
  std::string folder;
  std::string shard;       ///< that is made alone; empty: all
  int jobs = 0;            ///< 0: all cores
  bool overwrite = false;  ///< an unfinished study of other inputs
  bool json = false, markdown = false;
};

/// False, and a message: a case is unknown.
bool are_known(const std::vector<std::string>& cases, const std::optional<cloth::Scene>& scene) {
  std::vector<std::string> all;
  for (const cloth::ExtremeCase& extreme : cloth::empty_table({.scene = scene}).cases)
    all.push_back(extreme.name);
  for (const std::string& name : cases)
    if (std::find(all.begin(), all.end(), name) == all.end()) {
      say(fmt::format("--cases: {}: must be one of {}", name, fmt::join(all, ", ")));
      return false;
    }
  return true;
}

std::string command_of(const ExtremesArguments& arguments) {
  std::string command = "clothlab-cli extremes";
  if (!arguments.scene.empty()) command += " " + arguments.scene;
  command += settings_text(arguments.settings);
  if (!arguments.options.methods.empty())
    command += fmt::format(" --methods {}", fmt::join(arguments.options.methods, ","));
  if (!arguments.options.cases.empty())
    command += fmt::format(" --cases {}", fmt::join(arguments.options.cases, ","));
  return command;
}

int extremes(const ExtremesArguments& arguments) {
  cloth::ExtremesOptions options = arguments.options;
  options.jobs = chosen_jobs(arguments.jobs);
  if (!arguments.scene.empty()) {
    LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
    if (!loaded.scene) return loaded.exit_code;
    options.scene = std::move(loaded.scene);
  }
  if (!are_known(options.cases, options.scene)) return bad_input;
  const cloth::ExtremesTable plan = cloth::empty_table(options);
  if (options.scene)
    if (const int refused = refused_for_memory(*options.scene, plan.methods); refused != done) return refused;

  const auto made = make_study(
      plan, options,
      {arguments.folder, command_of(arguments), arguments.scene, arguments.overwrite, arguments.shard},
      [](const cloth::ExtremesOptions& all) { return cloth::run_extremes(all); });
  if (const int* failed = std::get_if<int>(&made)) return *failed;
  const cloth::ExtremesTable& table = std::get<0>(made).table;
  const int printed = print(arguments.json       ? cloth::study_json(table)
                            : arguments.markdown ? cloth::extremes_markdown(table)
                                                 : cloth::study_text(table));
  if (printed != done) return printed;
  return stop_is_requested() ? interrupted : done;
}

}  // namespace

void add_extremes(Program& program) {
  auto [command, arguments] =
      add_command(program, "extremes",
                  "Stiff and extreme cases, every method on each: a fixed list, or a scene pushed", extremes);
  CLI::Option* scene = command.add_option(
      "scene", arguments.scene, "A scene to push in one thing at a time; without it the fixed list of cases");
  add_settings(command, arguments.settings)->needs(scene);
  add_names(command, "--methods", arguments.options.methods, "Methods, between commas; all without",
            cloth::integrator_names());
  command.add_option("--cases", arguments.options.cases, "Cases, between commas; all without")
      ->delimiter(',')
      ->allow_extra_args(false);
  CLI::Option* out =
      add_path(command, "--out", arguments.folder,
               "Folder for extremes.csv, extremes.svg, study.json and report.html; made if missing");
  add_shard(command, arguments.shard, out);
  add_jobs(command, arguments.jobs, "Cells that are run at once, fewer where memory is short");
  add_overwrite(command, arguments.overwrite);
  CLI::Option* json = add_json(command, arguments.json);
  command.add_flag("--markdown", arguments.markdown, "Print the table as Markdown")
      ->excludes(json)
      ->excludes(scene);
}

}  // namespace clothlab::cli
