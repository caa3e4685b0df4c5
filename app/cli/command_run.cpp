#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "commands.h"
#include "console.h"
#include "progress.h"
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

}  // namespace

int run(const RunArguments& arguments) {
  const LoadedScene loaded = load_scene(arguments.scene, arguments.settings);
  if (!loaded.scene) return loaded.exit_code;
  const cloth::Scene& scene = *loaded.scene;
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
    options.threads = threads_for(arguments);
    options.progress = [&](double time) {
      bar.show(time / scene.duration, fmt::format("t = {:.2f} s", time));
      return !stop_is_requested();
    };
    result = cloth::run_scene(scene, options);
  }
  const cloth::RunSummary& summary = result.summary;
  if (!summary.notice.empty()) say(summary.notice);
  if (summary.divergence) say(cloth::describe(*summary.divergence));
  if (result.io_error) return report(*result.io_error);
  const int printed =
      print(arguments.json ? cloth::summary_json(summary) : summary_text(summary, arguments.folder));
  return printed == done ? exit_code_of(summary.status) : printed;
}

}  // namespace clothlab::cli
