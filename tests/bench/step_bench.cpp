// clothlab-bench: what a step costs on this machine (docs/performance.md).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "bench/peers/peer_tables.h"
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
  bool peers = false;
  bool repeats_given = false;
};

/// What was to be compared with is not in this build.
constexpr int not_built = 7;

std::vector<cloth::peers::PeerLibrary> peer_libraries() {
  std::vector<cloth::peers::PeerLibrary> libraries;
#ifdef CLOTHLAB_BULLET
  libraries.push_back({.name = "Bullet", .program = CLOTHLAB_BULLET, .is_single = false});
#endif
#ifdef CLOTHLAB_BULLET_SINGLE
  libraries.push_back({.name = "Bullet", .program = CLOTHLAB_BULLET_SINGLE, .is_single = true});
#endif
  return libraries;
}

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
  CLI::Option* only =
      add_names(app, "--only", study.parts,
                fmt::format("Only these parts: {}", fmt::join(speed_parts(), ", ")), speed_parts());
  std::vector<std::string> scenes;
  for (const cloth::BuiltinScene& scene : cloth::builtin_scenes()) scenes.push_back(scene.name);
  add_names(app, "--scenes", study.scenes, "Only these scenes, e.g. flag,wind", scenes);
  app.add_option("--scene-seconds", study.scene_seconds, "Seconds of stepping for each scene and size")
      ->capture_default_str()
      ->check(CLI::Range(0.001, 3600.0));
  app.add_flag(
         "--peers", arguments.peers,
         "In place of all parts: error against processor time of our methods beside Bullet's soft bodies "
         "on the same cloth; takes --sizes (33), --methods, --repeats (5) and --quick. Exit code 7 where "
         "this program was built without Bullet")
      ->excludes(only);
  app.add_flag("--quick", study.quick, "Small sizes and short timings: a look, not a measurement");
  add_path(app, "--out", arguments.folder,
           "Folder for bench.json; made if missing. Rows are timed in turn, so that a benchmark cannot go on "
           "after "
           "an interruption: the same command begins anew");
  CLI::Option* json = add_json(app, arguments.json);
  app.add_flag("--markdown", arguments.markdown, "Print the tables as Markdown")->excludes(json);
}

/// A report in the three ways that it can be had.
struct Pages {
  std::string json, markdown, text;
};

/// bench.json, and what was asked for on standard output. The exit code.
int show(const Arguments& arguments, cloth::ResultFolder& folder, const Pages& pages) {
  std::optional<cloth::IoError> failure;
  if (folder.is_open()) failure = folder.finish("bench.json", pages.json);
  const int printed = print(arguments.json ? pages.json : arguments.markdown ? pages.markdown : pages.text);
  if (failure) return report(*failure);  // what took so long is shown all the same
  return printed;
}

/// The exit code after a message; `done` where the folder, if there is one, is ours.
int claim(const Arguments& arguments, cloth::ResultFolder& folder) {
  if (!arguments.folder.empty())
    if (const auto error = folder.claim(arguments.folder, {.kind = "bench", .files = {"bench.json"}}))
      return report(*error);
  return done;
}

int compare_with_peers(const Arguments& arguments) {
  cloth::peers::PeerOptions options;
  options.libraries = peer_libraries();
  if (options.libraries.empty()) {
    say(cloth::peers::missing_library_message());
    return not_built;
  }
  const std::vector<std::string> known = cloth::peers::our_peer_methods();
  for (const std::string& method : arguments.study.methods)
    if (std::find(known.begin(), known.end(), method) == known.end()) {
      say(fmt::format("--peers: --methods: '{}' is not compared; {} are", method, fmt::join(known, ", ")));
      return bad_input;
    }
  listen_for_stop();
  cloth::ResultFolder folder;
  if (const int refused = claim(arguments, folder)) return refused;
  options.sizes = arguments.study.sizes;
  options.methods = arguments.study.methods;
  options.repeats = arguments.repeats_given ? arguments.study.repeats : arguments.study.quick ? 1 : 5;
  options.quick = arguments.study.quick;
  cloth::peers::PeerReport result;
  {
    Progress bar;
    options.progress = [&](double fraction, const std::string& text) {
      bar.show(fraction, text);
      return !stop_is_requested();
    };
    result = study_peers(options);
  }
  using namespace cloth::peers;
  const int shown = show(arguments, folder, {peer_json(result), peer_markdown(result), peer_text(result)});
  if (shown != done) return shown;
  return result.complete ? done : interrupted;
}

int bench(Arguments arguments) {
  listen_for_stop();
  cloth::ResultFolder folder;
  if (const int refused = claim(arguments, folder)) return refused;
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
  const int printed =
      show(arguments, folder, {speed_json(result), speed_markdown(result), speed_text(result)});
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
    arguments.repeats_given = app.count("--repeats") > 0;
    return arguments.peers ? compare_with_peers(arguments) : bench(arguments);
  });
}
