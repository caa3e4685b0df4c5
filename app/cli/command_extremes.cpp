#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "commands.h"
#include "console.h"
#include "integrators/registry.h"
#include "progress.h"
#include "studies.h"
#include "study/extremes_report.h"
#include "study/study_recorder.h"

namespace clothlab::cli {
namespace {

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> names;
  std::string name;
  for (const char c : list + ",") {
    if (c != ',') {
      name += c;
    } else if (!name.empty()) {
      names.push_back(std::move(name));
      name.clear();
    }
  }
  return names;
}

/// Those of `known` that are asked for, in their own order; all if none is asked for. False: one is unknown.
bool choose(const char* option, const std::vector<std::string>& asked, const std::vector<std::string>& known,
            std::vector<std::string>& chosen) {
  for (const std::string& name : asked) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    say(fmt::format("{} {}: must be among {}", option, name, fmt::join(known, ", ")));
    return false;
  }
  for (const std::string& name : known)
    if (asked.empty() || std::find(asked.begin(), asked.end(), name) != asked.end()) chosen.push_back(name);
  return true;
}

/// False, and a message: a method or case is unknown.
bool read_options(const ExtremesArguments& arguments, cloth::ExtremesOptions& options) {
  if (!choose("--methods", split(arguments.methods), cloth::integrator_names(), options.methods))
    return false;
  std::vector<std::string> all;
  for (const cloth::ExtremeCase& extreme : cloth::empty_table(options).cases) all.push_back(extreme.name);
  return choose("--cases", split(arguments.cases), all, options.cases);
}

std::string command_of(const ExtremesArguments& arguments) {
  std::string command = "clothlab-cli extremes";
  if (!arguments.scene.empty()) command += " " + arguments.scene;
  for (const std::string& setting : arguments.settings) command += " --set '" + setting + "'";
  if (!arguments.methods.empty()) command += " --methods " + arguments.methods;
  if (!arguments.cases.empty()) command += " --cases " + arguments.cases;
  return command;
}

}  // namespace

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
  listen_for_stop();

  cloth::StudyRecorder recorder;
  std::optional<cloth::IoError> failure;
  if (!arguments.folder.empty()) {
    cloth::StudyStart start{.command = command_of(arguments), .overwrite = arguments.overwrite};
    if (!arguments.scene.empty()) start.inputs = {arguments.scene};
    failure = recorder.begin(arguments.folder, cloth::empty_table(options), start);
    if (failure) return report(*failure);
    say_what_goes_on(recorder);
    if (recorder.earlier()) options.earlier = &std::get<cloth::ExtremesTable>(*recorder.earlier());
    options.partial = [&](const cloth::ExtremesTable& table) {  // on disk before the next begins
      if (!failure) failure = recorder.keep(table);
    };
  }
  const auto start = std::chrono::steady_clock::now();
  cloth::ExtremesTable table;
  {
    Progress bar;  // cells take very different times: what is left is a guess
    options.progress = [&](const cloth::StudyProgress& progress) {
      bar.show(progress.fraction, progress.text);
      return !failure && !stop_is_requested();
    };
    options.keep_going = [] { return !stop_is_requested(); };
    table = cloth::run_extremes(options);
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  if (!failure && recorder.is_open()) failure = recorder.end(table, wall.count());
  if (failure) return report(*failure);
  const int printed = print(arguments.json       ? cloth::extremes_json(table)
                            : arguments.markdown ? cloth::extremes_markdown(table)
                                                 : cloth::extremes_text(table));
  if (printed != done) return printed;
  return stop_is_requested() ? interrupted : done;
}

}  // namespace clothlab::cli
