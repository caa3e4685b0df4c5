#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "commands.h"
#include "console.h"
#include "io/result_folder.h"
#include "studies.h"
#include "study/validation/strip_bench.h"
#include "study/validation/validation_report.h"
#include "validate_scenes.h"

namespace clothlab::cli {
namespace {

struct ValidateArguments {
  std::vector<std::string> only;
  std::string folder, strips, scored;
  SceneChecks of_scenes;   ///< all but folder and json
  std::string shard;       ///< that is made alone; empty: all
  int jobs = 0;            ///< 0: all cores
  bool overwrite = false;  ///< an unfinished study of other inputs
  bool json = false;
};

/// The strips for other simulators.
int write_strips(const std::string& place) {
  const std::vector<cloth::ValidationRow> tasks = cloth::strip_tasks();
  std::vector<std::pair<std::string, std::string>> files{{"strips.csv", cloth::strips_csv(tasks)}};
  for (const cloth::ValidationRow& task : tasks) {
    files.emplace_back(name_of(task) + ".start.obj", cloth::starting_obj(task));
    files.emplace_back(name_of(task) + ".exact.csv", cloth::curve_csv(task.curve));
  }
  cloth::ResultFolder folder;
  cloth::FolderUse use{.kind = "strips", .files = {"strips.json"}};
  for (const auto& [name, text] : files) use.files.push_back(name);
  if (const auto error = folder.claim(place, use)) return report(*error);
  for (const auto& [name, text] : files)
    if (const auto error = folder.write(name, text, name.ends_with(".csv"))) return report(*error);
  if (const auto error = folder.finish("strips.json", cloth::strips_index(folder.digests())))
    return report(*error);
  return print(fmt::format("{} strips in {}\n", tasks.size(), place));
}

int score(const ValidateArguments& arguments) {
  std::vector<cloth::StripScore> scores;
  if (const auto error = cloth::score_folder(arguments.scored, scores)) return report(*error);
  const int printed = print(arguments.json ? cloth::score_json(scores) : cloth::score_text(scores));
  if (printed != done) return printed;
  return std::all_of(scores.begin(), scores.end(), [](const auto& one) { return one.failure.empty(); })
             ? done
             : bad_input;
}

int validate(const ValidateArguments& arguments) {
  if (!arguments.strips.empty()) return write_strips(arguments.strips);
  if (!arguments.scored.empty()) return score(arguments);
  if (!arguments.of_scenes.scenes.empty()) {
    SceneChecks checks = arguments.of_scenes;
    checks.folder = arguments.folder, checks.json = arguments.json;
    return validate_scenes(checks);
  }
  cloth::ValidationOptions options{.protocols = arguments.only, .jobs = chosen_jobs(arguments.jobs)};
  std::string command = "clothlab-cli validate";
  if (!arguments.only.empty()) command += fmt::format(" --only {}", fmt::join(arguments.only, ","));
  const auto made =
      make_study(cloth::plan_validation(options), options,
                 {arguments.folder, command + " --out DIR", "", arguments.overwrite, arguments.shard},
                 cloth::run_validation);
  if (const int* failed = std::get_if<int>(&made)) return *failed;
  const cloth::ValidationStudy& study = std::get<0>(made).table;
  const int printed = print(arguments.json ? cloth::study_json(study) : cloth::study_text(study));
  if (printed != done) return printed;
  if (!study.is_complete()) return interrupted;
  const bool holds =
      std::all_of(study.rows.begin(), study.rows.end(), [](const auto& row) { return row.holds(); });
  return holds ? done : differs;
}

/// --scene and what goes with it.
CLI::Option* add_scene_checks(CLI::App& command, SceneChecks& checks) {
  CLI::Option* scene = command.add_option(
      "--scene", checks.scenes,
      "Hold this scene, a file or a built-in one, against the measured points that its block measured names; "
      "may be given more than once");
  scene->allow_extra_args(false)->check(CLI::Validator(
      [](const std::string& name) { return name.empty() ? std::string("must name a scene") : std::string(); },
      ""));
  add_settings(command, checks.settings)->needs(scene);
  command
      .add_option(
          "--cells", checks.cells,
          "Cells across of each grid of --scene, from coarse to fine, e.g. 10,20,40; without it half, all, "
          "twice and four times those of the scene where its pins allow it")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->needs(scene);
  command
      .add_option(
          "--threads", checks.threads,
          "Threads that a step of --scene may use; without it all cores. The results are the same to the bit")
      ->check(CLI::Range(1, 1024))
      ->needs(scene);
  return scene;
}

}  // namespace

void add_validate(Program& program) {
  auto [command, arguments] = add_command(
      program, "validate",
      "Strips of a material against exact solutions, and how fabrics drape, on four grids, or scenes against "
      "measured points",
      validate);
  CLI::Option* only =
      add_names(command, "--only", arguments.only,
                fmt::format("Only these protocols, separated by commas: {}; without this option all "
                            "but drape, which takes much longer",
                            fmt::join(cloth::validation_protocols(), ", ")),
                cloth::validation_protocols());
  CLI::Option* out =
      add_path(command, "--out", arguments.folder,
               "Folder for validation.csv, validation.json and report.html, of --scene measured.csv and "
               "measured.json; made if missing");
  CLI::Option* strips =
      add_path(command, "--strips", arguments.strips,
               "Measure nothing; write the strips for other simulators into this folder: what they are made "
               "of, starting meshes and exact curves");
  CLI::Option* scored = add_path(command, "--score", arguments.scored,
                                 "Measure nothing; say how far the strips in this folder, NAME.csv or "
                                 "NAME.obj, are from the exact curves");
  for (CLI::Option* one : {strips, scored}) one->excludes(only)->excludes(out);
  strips->excludes(scored);
  CLI::Option* shard = add_shard(command, arguments.shard, out);
  CLI::Option* jobs = add_jobs(command, arguments.jobs, "Rows that are measured at once");
  CLI::Option* scene = add_scene_checks(command, arguments.of_scenes);
  for (CLI::Option* one : {only, strips, scored, shard, jobs}) scene->excludes(one);
  add_overwrite(command, arguments.overwrite);
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
