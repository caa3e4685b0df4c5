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
  std::vector<std::string> methods, cases;  ///< empty: all
  std::string folder;
  bool overwrite = false;  ///< an unfinished study of other inputs
  bool json = false, markdown = false;
};

/// Those of `known` that are asked for, in their own order; all if none is.
std::vector<std::string> chosen_of(const std::vector<std::string>& known,
                                   const std::vector<std::string>& asked) {
  std::vector<std::string> chosen;
  for (const std::string& name : known)
    if (asked.empty() || std::find(asked.begin(), asked.end(), name) != asked.end()) chosen.push_back(name);
  return chosen;
}

/// False, and a message: a case is unknown.
bool read_options(const ExtremesArguments& arguments, cloth::ExtremesOptions& options) {
  options.methods = chosen_of(cloth::integrator_names(), arguments.methods);
  std::vector<std::string> all;
  for (const cloth::ExtremeCase& extreme : cloth::empty_table(options).cases) all.push_back(extreme.name);
  for (const std::string& name : arguments.cases)
    if (std::find(all.begin(), all.end(), name) == all.end()) {
      say(fmt::format("--cases: {}: must be one of {}", name, fmt::join(all, ", ")));
      return false;
    }
  options.cases = chosen_of(all, arguments.cases);
  return true;
}

std::string command_of(const ExtremesArguments& arguments) {
  std::string command = "clothlab-cli extremes";
  if (!arguments.scene.empty()) command += " " + arguments.scene;
  command += settings_text(arguments.settings);
  if (!arguments.methods.empty()) command += fmt::format(" --methods {}", fmt::join(arguments.methods, ","));
  if (!arguments.cases.empty()) command += fmt::format(" --cases {}", fmt::join(arguments.cases, ","));
  return command;
}

int extremes(const ExtremesArguments& arguments) {
  cloth::ExtremesOptions options;
  if (!arguments.scene.empty()) {
    LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
    if (!loaded.scene) return loaded.exit_code;
    options.scene = std::move(loaded.scene);
  }
  if (!read_options(arguments, options)) return bad_input;
  if (options.scene)
    if (const int refused = refused_for_memory(*options.scene, options.methods); refused != done)
      return refused;

  const auto made =
      make_study(cloth::empty_table(options), options,
                 {arguments.folder, command_of(arguments), arguments.scene, arguments.overwrite},
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
  add_names(command, "--methods", arguments.methods, "Methods, between commas; all without",
            cloth::integrator_names());
  command.add_option("--cases", arguments.cases, "Cases, between commas; all without")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_path(command, "--out", arguments.folder,
           "Folder for extremes.csv, extremes.svg, study.json and report.html; made if missing");
  add_overwrite(command, arguments.overwrite);
  CLI::Option* json = add_json(command, arguments.json);
  command.add_flag("--markdown", arguments.markdown, "Print the table as Markdown")
      ->excludes(json)
      ->excludes(scene);
}

}  // namespace clothlab::cli
