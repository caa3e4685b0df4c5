// clothlab-bench: what a step costs on this machine (docs/performance.md).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "bench/speed/speed_tables.h"
#include "cli/console.h"
#include "cli/parse.h"
#include "cli/progress.h"
#include "integrators/registry.h"
#include "io/result_folder.h"
#include "scene/builtin_scenes.h"

namespace {

using namespace clothlab::cli;
using namespace cloth::speed;

struct Arguments {
  SpeedOptions study;
  std::string folder;
  bool json = false, markdown = false;
};

/// Beside the bare cloth.
std::vector<std::string> feature_names() {
  std::vector<std::string> names;
  for (const Feature& feature : features())
    if (&feature != &bare_feature()) names.push_back(feature.name);
  return names;
}

void add_options(CLI::App& app, Arguments& arguments) {
  SpeedOptions& study = arguments.study;
  app.add_option(
         "--sizes", study.sizes,
         "Particles along an edge, e.g. 64,128; 32 to 512 without. Scenes are refined to them, and as they "
         "are without")
      ->delimiter(',')
      ->check(CLI::Range(4, 2048));
  add_names(app, "--methods", study.methods, "Only these methods, e.g. verlet,rk4",
            cloth::integrator_names());
  add_names(app, "--features", study.features,
            fmt::format("Only these beside the bare step: {}; all without", fmt::join(feature_names(), ", ")),
            feature_names());
  app.add_option("--threads", study.threads, "Numbers of threads, e.g. 1,2; 1 and all cores without")
      ->delimiter(',')
      ->check(CLI::Range(1, 1024));
  app.add_option("--repeats", study.repeats, "Timings of each row")
      ->capture_default_str()
      ->check(CLI::Range(3, 1000));
  add_names(app, "--only", study.parts, fmt::format("Only these parts: {}", fmt::join(speed_parts(), ", ")),
            speed_parts());
  std::vector<std::string> scenes;
  for (const cloth::BuiltinScene& scene : cloth::builtin_scenes()) scenes.push_back(scene.name);
  add_names(app, "--scenes", study.scenes, "Only these scenes, e.g. flag,wind", scenes);
  app.add_option("--scene-seconds", study.scene_seconds, "Seconds of stepping for each scene and size")
      ->capture_default_str()
      ->check(CLI::Range(0.001, 3600.0));
  app.add_flag("--quick", study.quick, "Small sizes and short timings: a look, not a measurement");
  add_path(app, "--out", arguments.folder,
           "Folder for bench.json; made if missing. Rows are timed in turn, so that a benchmark cannot go on "
           "after "
           "an interruption: the same command begins anew");
  CLI::Option* json = add_json(app, arguments.json);
  app.add_flag("--markdown", arguments.markdown, "Print the tables as Markdown")->excludes(json);
}

int bench(Arguments arguments) {
  listen_for_stop();
  cloth::ResultFolder folder;
  if (!arguments.folder.empty())
    if (const auto error = folder.claim(arguments.folder, {.kind = "bench", .files = {"bench.json"}}))
      return report(*error);
  SpeedReport result;
  {
    Progress bar;
    arguments.study.program = CLOTHLAB_CLI;
    arguments.study.progress = [&](double fraction, const std::string& text) {
      bar.show(fraction, text);
      return !stop_is_requested();
    };
    result = study_speed(arguments.study);
  }
  const std::string json = speed_json(result);
  std::optional<cloth::IoError> failure;
  if (folder.is_open()) failure = folder.finish("bench.json", json);
  const int printed = print(arguments.json       ? json
                            : arguments.markdown ? speed_markdown(result)
                                                 : speed_text(result));
  if (failure) return report(*failure);  // what took so long is shown all the same
  if (printed != done) return printed;
  if (!result.reference_agrees()) {
    say(fmt::format(
        "semi-implicit Euler and the reference kernel are {:.3g} m apart: the times are not to be compared",
        result.disagreement));
    return diverged;
  }
  return result.complete ? done : interrupted;
}

}  // namespace

const char* const clothlab::cli::program_name = "clothlab-bench";

int main(int argc, char** argv) {
  return run_program([&] {
    CLI::App app{"What a step costs on this machine, beside a plain kernel and the machine's own limits.",
                 program_name};
    Arguments arguments;
    add_options(app, arguments);
    if (const auto ended = parse(app, argc, argv)) return *ended;
    return bench(arguments);
  });
}
