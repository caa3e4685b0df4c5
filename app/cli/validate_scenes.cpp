#include "validate_scenes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>

#include "console.h"
#include "io/result_folder.h"
#include "progress.h"
#include "scene/scene_mesh.h"
#include "simulation/step_batches.h"
#include "studies.h"
#include "study/validation/scene_validation_report.h"

namespace clothlab::cli {
namespace {

using Studies = std::vector<cloth::SceneValidation>;

/// A scene with its points, or the exit code after a message.
std::optional<int> plan(const std::string& name, const SceneChecks& checks, Studies& studies) {
  const LoadedScene loaded = load_scene(name, checks.settings);
  if (!loaded.scene) return loaded.exit_code;
  const cloth::Scene& scene = *loaded.scene;
  if (!scene.measured)
    return report({{"measured", "",
                    "must be given: the file of measured points that the scene is held against", name}});
  cloth::MeasuredReading reading = cloth::read_measured(scene);
  std::vector<cloth::Problem> problems = std::move(reading.problems);
  if (problems.empty()) problems = cloth::find_grid_problems(scene, checks.cells);
  for (cloth::Problem& problem : problems)
    if (problem.place.empty() && problem.path != "--cells") problem.place = name;
  if (!problems.empty()) return report(problems);
  studies.push_back(cloth::plan_scene_validation(name, scene, std::move(reading.data), checks.cells));
  return std::nullopt;
}

std::string command_of(const SceneChecks& checks) {
  std::string text = "clothlab-cli validate";
  for (const std::string& scene : checks.scenes) text += " --scene " + scene;
  text += settings_text(checks.settings);
  if (!checks.cells.empty()) text += fmt::format(" --cells {}", fmt::join(checks.cells, ","));
  return text + " --out DIR";
}

std::optional<cloth::IoError> claim_folder(cloth::ResultFolder& folder, const SceneChecks& checks,
                                           const Studies& studies) {
  cloth::FolderUse use{.kind = "measured", .files = {"measured.csv", "report.html", "measured.json"}};
  for (const std::string& scene : checks.scenes) use.inputs.emplace_back(scene);
  for (const cloth::SceneValidation& study : studies) {
    for (const auto& mesh : cloth::mesh_files(study.scene)) use.inputs.emplace_back(mesh);
    use.inputs.push_back(cloth::measured_path(study.scene));
  }
  return folder.claim(checks.folder, use);
}

std::optional<cloth::IoError> write_folder(cloth::ResultFolder& folder, const Studies& studies,
                                           const std::string& command, double wall) {
  if (const auto error = folder.write("measured.csv", cloth::scenes_csv(studies), true)) return error;
  if (const auto error = folder.write("report.html", cloth::scenes_page(studies, command, wall)))
    return error;
  return folder.finish("measured.json", cloth::scenes_json(studies, folder.digests()));
}

void run_all(const SceneChecks& checks, Studies& studies) {
  Progress bar;
  for (std::size_t k = 0; k < studies.size(); ++k) {
    cloth::SceneValidationOptions options;
    options.threads = checks.threads > 0 ? checks.threads : cloth::machine_threads();
    options.stop = stop_is_requested;
    options.progress = [&](const cloth::StudyProgress& progress) {
      bar.show((static_cast<double>(k) + progress.fraction) / static_cast<double>(studies.size()),
               progress.text);
      return !stop_is_requested();
    };
    run_scene_validation(studies[k], options);
  }
}

}  // namespace

int validate_scenes(const SceneChecks& checks) {
  Studies studies;
  for (const std::string& name : checks.scenes)
    if (const auto failed = plan(name, checks, studies)) return *failed;
  listen_for_stop();
  cloth::ResultFolder folder;
  if (!checks.folder.empty())
    if (const auto error = claim_folder(folder, checks, studies)) return report(*error);
  const auto start = std::chrono::steady_clock::now();
  run_all(checks, studies);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (folder.is_open())
    if (const auto error = write_folder(folder, studies, command_of(checks), wall)) return report(*error);
  if (const int printed = print(checks.json ? cloth::scenes_json(studies) : cloth::scenes_text(studies));
      printed != done)
    return printed;
  if (!std::all_of(studies.begin(), studies.end(), [](const auto& one) { return one.is_complete(); }))
    return interrupted;
  return std::all_of(studies.begin(), studies.end(), [](const auto& one) { return one.holds(); }) ? done
                                                                                                  : differs;
}

}  // namespace clothlab::cli
