#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "analysis/fit_report.h"
#include "commands.h"
#include "console.h"
#include "progress.h"
#include "studies.h"
#include "study/identify/fit_folder.h"

namespace clothlab::cli {
namespace {

struct IdentifyArguments {
  std::string scene;
  std::vector<std::string> settings, vary, targets, held_out, measured;
  std::string method = cloth::name_of(cloth::FitMethod::levenberg_marquardt);
  cloth::FitOptions options;  ///< starts, descents, iterations, seed
  int jobs = 0;               ///< 0: as many as the machine has
  std::string folder;
  bool json = false;
};

std::string command_of(const IdentifyArguments& arguments) {
  std::string text = "clothlab-cli identify " + arguments.scene + settings_text(arguments.settings);
  const auto add = [&](const char* option, const std::vector<std::string>& values) {
    for (const std::string& value : values) text += fmt::format(" {} '{}'", option, value);
  };
  add("--vary", arguments.vary);
  add("--target", arguments.targets);
  add("--held-out", arguments.held_out);
  add("--measured", arguments.measured);
  const cloth::FitOptions usual;
  if (arguments.method != cloth::name_of(usual.method)) text += " --method " + arguments.method;
  if (arguments.options.starts != usual.starts) text += fmt::format(" --starts {}", arguments.options.starts);
  if (arguments.options.descents != usual.descents)
    text += fmt::format(" --descents {}", arguments.options.descents);
  if (arguments.options.seed != usual.seed) text += fmt::format(" --seed {}", arguments.options.seed);
  if (arguments.options.difference_step > 0)
    text += fmt::format(" --difference-step {}", arguments.options.difference_step);
  return text + (arguments.folder.empty() ? "" : " --out DIR");
}

/// Notes what was read, or what is wrong with it.
template <class Item>
void take(std::variant<Item, cloth::Problem> read, std::vector<Item>& items,
          std::vector<cloth::Problem>& problems) {
  if (auto* problem = std::get_if<cloth::Problem>(&read))
    problems.push_back(*problem);
  else
    items.push_back(std::get<Item>(std::move(read)));
}

std::vector<cloth::Problem> fill(const IdentifyArguments& arguments, cloth::IdentifyPlan& plan) {
  std::vector<cloth::Problem> problems;
  for (const std::string& text : arguments.vary)
    take(cloth::parse_vary(text, plan.scene), plan.varied, problems);
  for (const std::string& text : arguments.targets)
    take(cloth::parse_target(text, plan.scene, "--target"), plan.targets, problems);
  const std::size_t fitted = plan.targets.size();
  for (const std::string& text : arguments.held_out)
    take(cloth::parse_target(text, plan.scene, "--held-out"), plan.targets, problems);
  for (std::size_t k = fitted; k < plan.targets.size(); ++k) plan.targets[k].held_out = true;
  for (const std::string& file : arguments.measured) {
    auto read = cloth::read_curves(file, plan.scene);
    if (const auto* bad = std::get_if<1>(&read))
      problems.insert(problems.end(), bad->begin(), bad->end());
    else
      for (cloth::FittedCurve& curve : std::get<0>(read)) plan.curves.push_back(std::move(curve));
  }
  if (problems.empty()) problems = find_problems(plan);
  return problems;
}

int exit_code_of_fit(const cloth::FitResult& result) {
  if (result.status == cloth::FitStatus::stopped) return interrupted;
  if (result.status != cloth::FitStatus::converged) return diverged;
  return result.all_identified() ? done : not_identified;
}

cloth::FitAccount carry_out(cloth::IdentifyPlan& plan) {
  listen_for_stop();
  plan.stop = stop_is_requested;
  Progress bar;
  const auto expected = static_cast<double>(
      plan.options.starts + plan.options.descents * 6 * (2 * plan.varied.size() + 1));  // a guess
  plan.options.progress = [&](const cloth::FitProgress& progress) {
    const auto runs = static_cast<double>(progress.evaluations);
    bar.show(runs / (runs + std::max(expected - runs, 0.1 * runs)),
             fmt::format("{} runs, chi squared {:.4g}", progress.evaluations, progress.chi_squared));
    return true;
  };
  return cloth::identify(plan);
}

int identify(const IdentifyArguments& arguments) {
  LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
  if (!loaded.scene) return loaded.exit_code;
  cloth::IdentifyPlan plan{.scene = std::move(*loaded.scene), .options = arguments.options};
  plan.command = command_of(arguments);
  plan.jobs = chosen_jobs(arguments.jobs);
  for (const auto method : {cloth::FitMethod::levenberg_marquardt, cloth::FitMethod::derivative_free})
    if (arguments.method == cloth::name_of(method)) plan.options.method = method;
  if (const auto problems = fill(arguments, plan); !problems.empty()) return report(problems);
  if (const int refused = refused_for_memory(plan.scene); refused != done) return refused;

  cloth::FitFolder folder;
  if (!arguments.folder.empty()) {
    std::vector<std::filesystem::path> inputs{arguments.measured.begin(), arguments.measured.end()};
    inputs.emplace_back(arguments.scene);
    if (const auto error = folder.begin(arguments.folder, plan, inputs)) return report(*error);
    plan.runs = folder.runs();
    if (const std::size_t before = plan.runs->read_count(); before > 0)
      say(fmt::format("{} runs were made before", before));
  }
  const cloth::FitAccount account = carry_out(plan);
  if (folder.is_open())
    if (const auto error = folder.end(plan, account)) return report(*error);
  std::string text = arguments.json ? cloth::fit_json(account) : cloth::fit_text(account);
  if (!arguments.json && !arguments.folder.empty()) text += "results in " + arguments.folder + "\n";
  if (const int printed = print(text); printed != done) return printed;
  return exit_code_of_fit(account.result);
}

void add_search_options(CLI::App& command, IdentifyArguments& arguments) {
  command
      .add_option(
          "--method", arguments.method,
          "levenberg-marquardt (slopes by central differences) or derivative-free (Subplex; for outputs "
          "that jump)")
      ->check(CLI::IsMember(
          std::vector<std::string>(std::begin(cloth::fit_method_names), std::end(cloth::fit_method_names))));
  command
      .add_option("--starts", arguments.options.starts,
                  "Points of a Latin hypercube that are looked at beside the scene's own values (10)")
      ->check(CLI::Range(0, 10000));
  command
      .add_option("--descents", arguments.options.descents,
                  "Descents, from the scene's own values and from the best of these points (3)")
      ->check(CLI::Range(1, 1000));
  command
      .add_option("--difference-step", arguments.options.difference_step,
                  "Of central differences, as a part of the value (0.001; derivative-free 0.05)")
      ->check(CLI::Range(1e-9, 0.5));
  command.add_option("--seed", arguments.options.seed, "Of the Latin hypercube (1)");
  add_jobs(command, arguments.jobs, "Runs beside each other");
}

}  // namespace

void add_identify(Program& program) {
  auto [command, arguments] =
      add_command(program, "identify",
                  "Parameters of a scene from measured values, with what the values cannot tell", identify);
  add_scene(command, arguments.scene)->required();
  add_settings(command, arguments.settings);
  command
      .add_option(
          "--vary", arguments.vary,
          "A parameter to find, PATH or PATH:LOW:HIGH, e.g. springs.structural:10:1000; without a range "
          "from a tenth of the scene's value to ten times it; may be repeated")
      ->allow_extra_args(false);
  command
      .add_option("--target", arguments.targets,
                  "A measured value, SOURCE=VALUE or SOURCE=VALUE±SIGMA (+- too) at the end of the run, "
                  "SOURCE:max, :min or :mean over its rows, e.g. max_strain:max=0.05±0.002; sources are the "
                  "columns of record.csv, lowest_point, sag, droop_ratio and extent; may be repeated")
      ->allow_extra_args(false);
  command
      .add_option("--held-out", arguments.held_out,
                  "A measured value that is not fitted but predicted from the fit; like --target")
      ->allow_extra_args(false);
  command
      .add_option(
          "--measured", arguments.measured,
          "A CSV file with a column time_s and columns named as in record.csv; NAME_sigma has the standard "
          "deviations of NAME; may be repeated")
      ->allow_extra_args(false);
  add_search_options(command, arguments);
  add_path(
      command, "--out", arguments.folder,
      "Folder for identified.json, parameters.csv, targets.csv, fitted.scene.json, the curves as SVG and "
      "report.html, and for runs.jsonl, by which a fit that was stopped goes on; made if missing");
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
