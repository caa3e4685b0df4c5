#include <fmt/format.h>

#include <algorithm>

#include "cloth/cloth_obj.h"
#include "cloth/mesh_cloth.h"
#include "commands.h"
#include "console.h"
#include "io/user_file.h"
#include "picture_option.h"
#include "progress.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "scene/scene_mesh.h"
#include "simulation/recorder.h"
#include "simulation/run_summary.h"
#include "simulation/step_batches.h"
#include "simulation/time_step.h"

namespace clothlab::cli {
namespace {

struct RunArguments {
  std::string scene;
  std::vector<std::string> settings;
  std::string folder;
  std::string obj;  ///< a file for the cloth after the last step; empty: none
  PictureArguments picture;
  int threads = 0;  ///< 0: as many as the machine has
  bool json = false;
};

/// What would keep a run from its end, said before it begins: more steps or memory than there can be.
int refusal(const cloth::Scene& scene, double time_step) {
  if (const auto rule = cloth::too_many_steps(scene.duration, time_step))
    return report({{"duration", fmt::format("{} s", scene.duration), *rule, "", 0, 0}});
  return refused_for_memory(scene);
}

/// A file for one thing that the run leaves beside its folder.
struct Output {
  const char* name;
  std::filesystem::path path;
};

std::vector<Output> outputs_of(const RunArguments& arguments) {
  std::vector<Output> outputs;
  if (!arguments.obj.empty()) outputs.push_back({"the OBJ file", arguments.obj});
  if (!arguments.picture.file.empty()) outputs.push_back({"the picture", arguments.picture.file});
  return outputs;
}

/// Where an output would replace what is read or another one, or be replaced by the run's own files.
std::optional<cloth::IoError> misplaced(const Output& output, const RunArguments& arguments,
                                        const cloth::Scene& scene) {
  std::vector<std::filesystem::path> inputs{arguments.scene};
  for (const std::string& mesh : cloth::mesh_files(scene)) inputs.emplace_back(mesh);
  if (auto error = cloth::overwritten_input(output.path, inputs)) return error;
  std::error_code ignored;
  const auto place = std::filesystem::weakly_canonical(output.path, ignored);
  for (const Output& other : outputs_of(arguments))
    if (other.name != output.name && std::filesystem::weakly_canonical(other.path, ignored) == place)
      return cloth::IoError{
          output.path, fmt::format("is where {} goes too: give {} another name", other.name, output.name),
          true};
  const auto folder = std::filesystem::weakly_canonical(arguments.folder, ignored);
  const auto& names = cloth::run_files();
  if (arguments.folder.empty() || place.parent_path() != folder ||
      std::find(names.begin(), names.end(), output.path.filename()) == names.end())
    return std::nullopt;
  return cloth::IoError{
      output.path, fmt::format("is one of the files that --out leaves: give {} another name", output.name),
      true};
}

std::optional<cloth::IoError> write_outputs(const RunArguments& arguments, const cloth::Scene& scene,
                                            const cloth::ClothState& state) {
  if (outputs_of(arguments).empty()) return std::nullopt;
  const cloth::ClothSystem system = make_cloth(scene);
  if (!arguments.obj.empty())
    if (auto error = cloth::write_user_file(
            arguments.obj, cloth_obj(system, state, cloth::title_at(scene.title, state.time))))
      return error;
  if (arguments.picture.file.empty()) return std::nullopt;
  return write_picture(arguments.picture, scene, system, state);
}

int run(const RunArguments& arguments) {
  const std::vector<Output> outputs = outputs_of(arguments);
  for (const Output& output : outputs)
    if (const auto error = cloth::problem_of_user_file(output.path)) return report(*error);
  const LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
  if (!loaded.scene) return loaded.exit_code;
  const cloth::Scene& scene = *loaded.scene;
  for (const Output& output : outputs)
    if (const auto error = misplaced(output, arguments, scene)) return report(*error);
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
    options.threads = arguments.threads > 0 ? arguments.threads : cloth::machine_threads();
    options.progress = [&](double time) {
      bar.show(time / scene.duration, fmt::format("t = {:.2f} s", time));
      return !stop_is_requested();
    };
    result = cloth::run_scene(scene, options);
  }
  const cloth::RunSummary& summary = result.summary;
  say_what_went_wrong(summary);
  if (result.io_error) return report(*result.io_error);
  if (const auto error = write_outputs(arguments, scene, result.final_state)) return report(*error);
  const int printed =
      print(arguments.json ? cloth::summary_json(summary) : summary_text(summary, arguments.folder));
  return printed == done ? exit_code_of(summary) : printed;
}

}  // namespace

void add_run(Program& program) {
  auto [command, arguments] = add_command(program, "run", "Run a scene to its duration", run);
  add_scene(command, arguments.scene)->required();
  add_settings(command, arguments.settings);
  add_path(command, "--out", arguments.folder,
           "Folder for scene.json, record.csv, final_state.csv and summary.json; made if missing");
  add_path(command, "--obj", arguments.obj,
           "OBJ file for the cloth after the last step, with normals; of a grid also texture coordinates");
  add_picture(command, arguments.picture);
  command
      .add_option("--threads", arguments.threads,
                  "Threads that a step may use; without it all cores. The results are the same to the bit. "
                  "They are used while they are seen to gain; summary.json says how many could be")
      ->check(CLI::Range(1, 1024));
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
