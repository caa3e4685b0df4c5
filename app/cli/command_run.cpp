#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "cloth/mesh_cloth.h"
#include "commands.h"
#include "console.h"
#include "io/cloth_obj.h"
#include "io/run_folder.h"
#include "progress.h"
#include "scene/scene_mesh.h"
#include "simulation/recorder.h"
#include "simulation/time_step.h"

namespace clothlab::cli {
namespace {

int exit_code_of(cloth::Status status) {
  switch (status) {
    case cloth::Status::finished:
      return done;
    case cloth::Status::diverged:
      return diverged;
    case cloth::Status::stopped:
      return interrupted;
  }
  return done;
}

int threads_for(const RunArguments& arguments) {
  if (arguments.threads > 0) return arguments.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Before a run that may be long.
std::optional<cloth::IoError> missing_folder_of(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  if (folder.empty() || std::filesystem::is_directory(folder)) return std::nullopt;
  return cloth::IoError{file, "there is no folder " + folder.string()};
}

/// Where the OBJ file would replace what is read, or be replaced by the run's own files.
std::optional<cloth::IoError> misplaced_obj(const RunArguments& arguments, const cloth::Scene& scene) {
  if (arguments.obj.empty()) return std::nullopt;
  const std::filesystem::path obj = arguments.obj;
  std::vector<std::filesystem::path> inputs{arguments.scene};
  for (const std::string& mesh : cloth::mesh_files(scene)) inputs.emplace_back(mesh);
  if (auto error = cloth::overwritten_input(obj, inputs)) return error;
  std::error_code ignored;
  const auto folder = std::filesystem::weakly_canonical(arguments.folder, ignored);
  if (arguments.folder.empty() || std::filesystem::weakly_canonical(obj, ignored).parent_path() != folder)
    return std::nullopt;
  const auto& names = cloth::run_files();
  if (std::find(names.begin(), names.end(), obj.filename()) == names.end()) return std::nullopt;
  return cloth::IoError{obj, "is one of the files that --out leaves: give the OBJ file another name", true};
}

std::optional<cloth::IoError> write_cloth(const cloth::Scene& scene, const cloth::ClothState& state,
                                          const std::string& path) {
  const cloth::ClothSystem system = make_cloth(scene.cloth, scene.springs.value_or(cloth::SpringMaterial{}));
  return cloth::write_text_file(path, cloth_obj(system, state, cloth::title_at(scene.title, state.time)));
}

}  // namespace

int run(const RunArguments& arguments) {
  if (const auto error = missing_folder_of(arguments.obj)) return report(*error);
  const LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
  if (!loaded.scene) return loaded.exit_code;
  const cloth::Scene& scene = *loaded.scene;
  if (const auto error = misplaced_obj(arguments, scene)) return report(*error);
  const auto time_step = cloth::resolved_time_step(scene);
  if (!time_step) {
    say(cloth::no_stable_step_text(scene));
    return bad_input;
  }
  if (!scene.integrator.time_step) say(fmt::format("time step: auto, {:.6g} s", *time_step));

  listen_for_stop();
  cloth::RunResult result;
  {
    Progress bar;
    cloth::RunOptions options;
    options.folder = arguments.folder;
    options.inputs = {arguments.scene};
    options.threads = threads_for(arguments);
    options.progress = [&](double time) {
      bar.show(time / scene.duration, fmt::format("t = {:.2f} s", time));
      return !stop_is_requested();
    };
    result = cloth::run_scene(scene, options);
  }
  const cloth::RunSummary& summary = result.summary;
  if (!summary.notice.empty()) say(summary.notice);
  if (!summary.step_changes.empty()) say(cloth::describe(summary.step_changes));
  if (summary.divergence) say(cloth::describe(*summary.divergence));
  if (result.io_error) return report(*result.io_error);
  if (!arguments.obj.empty())
    if (const auto error = write_cloth(scene, result.final_state, arguments.obj)) return report(*error);
  const int printed =
      print(arguments.json ? cloth::summary_json(summary) : summary_text(summary, arguments.folder));
  return printed == done ? exit_code_of(summary.status) : printed;
}

}  // namespace clothlab::cli
