#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "commands.h"
#include "compare/builtin_comparisons.h"
#include "compare/comparison_json.h"
#include "compare/comparison_recorder.h"
#include "compare/comparison_report.h"
#include "console.h"
#include "integrators/registry.h"
#include "progress.h"
#include "simulation/memory_estimate.h"
#include "studies.h"

namespace clothlab::cli {
namespace {

struct CompareArguments {
  std::string file;   ///< or a built-in comparison
  std::string scene;  ///< without a file: this scene, a pane for each of `methods`
  std::vector<std::string> methods;
  std::vector<std::string> settings;
  std::optional<double> duration;  ///< s
  std::string reference;           ///< empty: the comparison's own
  std::string folder;
  int threads = 1;
  bool list = false, json = false;
};

struct LoadedComparison {
  std::optional<cloth::Comparison> comparison;
  int exit_code = done;
};

int list_comparisons(bool as_json) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::string text;
  for (const cloth::BuiltinComparison& builtin : cloth::builtin_comparisons()) {
    list.push_back({{"name", builtin.name}, {"title", builtin.title}});
    text += fmt::format("{:<20} {}\n", builtin.name, builtin.title);
  }
  return print(as_json ? nlohmann::ordered_json{{"comparisons", list}}.dump(2) + "\n" : text);
}

std::vector<std::string> settings_of(const CompareArguments& arguments) {
  std::vector<std::string> settings = arguments.settings;
  if (arguments.duration) settings.push_back(fmt::format("duration={}", *arguments.duration));
  return settings;
}

/// A file or a built-in comparison; a file wins.
LoadedComparison load_file(const CompareArguments& arguments) {
  const auto overrides = parse_settings(settings_of(arguments));
  if (!overrides) return {std::nullopt, bad_input};
  const cloth::BuiltinComparison* builtin = cloth::find_builtin_comparison(arguments.file);
  const NamedText named =
      read_named(arguments.file, builtin ? &builtin->text : nullptr, "comparison", "compare --list");
  if (named.exit_code != done) return {std::nullopt, named.exit_code};
  cloth::ComparisonReading reading = cloth::read_comparison(named.text, arguments.file, *overrides);
  if (!reading.comparison) return {std::nullopt, report(reading.problems)};
  return {std::move(reading.comparison), done};
}

/// `--scene S --methods a,b`: a pane for each method, nothing else differs.
LoadedComparison from_methods(const CompareArguments& arguments) {
  if (arguments.methods.size() < cloth::least_panes || arguments.methods.size() > cloth::max_panes) {
    say(fmt::format("--methods: {} given; a comparison has {} to {}", arguments.methods.size(),
                    cloth::least_panes, cloth::max_panes));
    return {std::nullopt, bad_input};
  }
  const LoadedScene loaded = load_scene(arguments.scene, settings_of(arguments));
  if (!loaded.scene) return {std::nullopt, loaded.exit_code};
  cloth::Comparison comparison{.title = {}, .scene = *loaded.scene, .panes = {}};
  comparison.panes = cloth::panes_for(arguments.methods);
  return {std::move(comparison), done};
}

LoadedComparison load(const CompareArguments& arguments) {
  if (arguments.file.empty() == arguments.scene.empty()) {
    say("compare: give a comparison, or --scene SCENE --methods a,b");
    return {std::nullopt, bad_input};
  }
  LoadedComparison loaded = arguments.file.empty() ? from_methods(arguments) : load_file(arguments);
  if (!loaded.comparison) return loaded;
  if (!arguments.reference.empty()) loaded.comparison->reference = arguments.reference;
  std::vector<cloth::Problem> problems = cloth::find_problems(*loaded.comparison);
  if (problems.empty()) problems = cloth::find_start_problems(*loaded.comparison);
  for (cloth::Problem& problem : problems)
    problem.place = problem.path == "reference" ? "--reference" : arguments.file + arguments.scene;
  if (!problems.empty()) return {std::nullopt, report(problems)};
  return loaded;
}

std::string command_of(const CompareArguments& arguments) {
  std::string text = "clothlab-cli compare";
  if (!arguments.file.empty())
    text += " " + arguments.file;
  else
    text += fmt::format(" --scene {} --methods {}", arguments.scene, fmt::join(arguments.methods, ","));
  text += settings_text(arguments.settings);
  if (arguments.duration) text += fmt::format(" --duration {}", *arguments.duration);
  if (!arguments.reference.empty()) text += " --reference " + arguments.reference;
  return text + " --out DIR";
}

/// The summary, which describes the other files, comes last.
std::optional<cloth::IoError> write_reports(const CompareArguments& arguments, cloth::ResultFolder& folder,
                                            cloth::ComparisonRun& run) {
  if (auto error = folder.write("compare.svg", cloth::to_svg(cloth::main_plot(run)))) return error;
  if (auto error = folder.write("report.html", cloth::comparison_page(run, command_of(arguments))))
    return error;
  run.files = folder.digests();
  return folder.finish("summary.json", cloth::comparison_summary(run));
}

/// The text has it among its notes; beside JSON it is for people.
void say_what_is_not_as_asked(const cloth::ComparisonRun& run) {
  if (!run.notice.empty()) say(run.notice);
  for (const cloth::PaneResult& pane : run.panes)
    if (pane.rate_breach) say(fmt::format("pane {}: {}", pane.name, describe(*pane.rate_breach)));
}

int finish(const CompareArguments& arguments, cloth::ResultFolder& folder, cloth::ComparisonRun& run) {
  if (run.io_error) return report(*run.io_error);
  if (folder.is_open())
    if (const auto error = write_reports(arguments, folder, run)) return report(*error);
  if (!run.reference_failure.empty()) say("the reference stopped: " + run.reference_failure);
  if (arguments.json) say_what_is_not_as_asked(run);
  std::string text = arguments.json ? cloth::comparison_summary(run) : cloth::comparison_text(run);
  if (!arguments.json && !arguments.folder.empty()) text += "results in " + arguments.folder + "\n";
  if (const int printed = print(text); printed != done) return printed;
  if (run.stopped) return interrupted;
  if (!run.has_result()) return diverged;
  return run.rate_is_kept() ? done : rate_not_kept;
}

int compare(const CompareArguments& arguments) {
  if (arguments.list) return list_comparisons(arguments.json);
  const LoadedComparison loaded = load(arguments);
  if (!loaded.comparison) return loaded.exit_code;
  const cloth::Comparison& comparison = *loaded.comparison;

  std::vector<cloth::Scene> scenes;
  for (std::size_t i = 0; i < comparison.panes.size(); ++i) scenes.push_back(scene_of(comparison, i));
  if (const auto problem = cloth::memory_problem(scenes)) {
    say(*problem);
    return io_failed;
  }

  listen_for_stop();
  cloth::ResultFolder folder;
  if (!arguments.folder.empty()) {
    cloth::FolderUse use = cloth::comparison_use(comparison);
    use.inputs.emplace_back(arguments.file.empty() ? arguments.scene : arguments.file);
    if (const auto error = folder.claim(arguments.folder, use)) return report(*error);
  }
  cloth::ComparisonRun run;
  {
    Progress bar;
    run = cloth::run_comparison(comparison, {.folder = {},
                                             .threads = arguments.threads,
                                             .progress =
                                                 [&](double time) {
                                                   bar.show(time / comparison.scene.duration,
                                                            fmt::format("t = {:.2f} s", time));
                                                 },
                                             .may_go_on = [] { return !stop_is_requested(); },
                                             .results = folder.is_open() ? &folder : nullptr});
  }
  return finish(arguments, folder, run);
}

}  // namespace

void add_compare(Program& program) {
  auto [command, arguments] = add_command(
      program, "compare",
      "Two to four methods, steps or values on one scene, in lock step: differences and a ranking", compare);
  CLI::Option* file =
      command.add_option("comparison", arguments.file, "A .compare.json file or a built-in comparison");
  CLI::Option* scene = command.add_option("--scene", arguments.scene,
                                          "Without a file: this scene, a pane for each of --methods");
  CLI::Option* methods = add_names(command, "--methods", arguments.methods,
                                   "Two to four methods, e.g. verlet,rk4", cloth::integrator_names());
  scene->needs(methods)->excludes(file);
  methods->needs(scene);
  add_settings(command, arguments.settings);
  command.add_option("--duration", arguments.duration, "Simulated time in s, instead of the scene's")
      ->check(CLI::PositiveNumber);
  command.add_option("--reference", arguments.reference,
                     "What differences are measured from: the name of a pane, controlled (the shared scene "
                     "under error control) or none");
  add_path(command, "--out", arguments.folder,
           "Folder for A.csv, B.csv, ..., compare.csv, comparison.json, summary.json, compare.svg and "
           "report.html; made if missing. A comparison is one run: after an interruption the same command "
           "begins anew");
  command
      .add_option("--threads", arguments.threads,
                  "Panes that step at the same time; with more than one, costs contain what they take from "
                  "each other")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command.add_flag("--list", arguments.list, "List the built-in comparisons");
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
