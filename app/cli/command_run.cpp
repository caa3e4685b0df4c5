#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "cloth/mesh_cloth.h"
#include "commands.h"
#include "console.h"
#include "io/cloth_obj.h"
#include "io/run_folder.h"
#include "io/user_file.h"
#include "progress.h"
#include "scene/scene_checks.h"
#include "scene/scene_mesh.h"
#include "simulation/recorder.h"
#include "simulation/time_step.h"

namespace clothlab::cli {
namespace {

int exit_code_of(const cloth::RunSummary& summary) {
  switch (summary.status) {
    case cloth::Status::finished:
      return summary.rate_breach ? rate_not_kept : done;
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

/// What would keep a run from its end, said before it begins: more steps or memory than there can be.
int refusal(const cloth::Scene& scene, double time_step) {
  if (const auto rule = cloth::too_many_steps(scene.duration, time_step))
    return report({{"duration", fmt::format("{} s", scene.duration), *rule, "", 0, 0}});
  return refused_for_memory(scene);
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
  return cloth::write_user_file(path, cloth_obj(system, state, cloth::title_at(scene.title, state.time)));
}

}  // namespace

int run(const RunArguments& arguments) {
  if (!arguments.obj.empty())
    if (const auto error = cloth::problem_of_user_file(arguments.obj)) return report(*error);
  const LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
  if (!loaded.scene) return loaded.exit_code;
  const cloth::Scene& scene = *loaded.scene;
  if (const auto error = misplaced_obj(arguments, scene)) return report(*error);
  const auto time_step = cloth::resolved_time_step(scene);
  if (!time_step) {
    say(cloth::no_stable_step_text(scene));
    return bad_input;
  }
  if (const int refused = refusal(scene, *time_step); refused != done) return refused;
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
  return printed == done ? exit_code_of(summary) : printed;
}

}  // namespace clothlab::cli
