#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "commands.h"
#include "console.h"
#include "integrators/registry.h"
#include "io/result_folder.h"
#include "progress.h"
#include "study/speed/speed_tables.h"

namespace clothlab::cli {
namespace {

namespace speed = cloth::speed;

/// True if every name is known; says which is not otherwise.
bool are_known(const char* option, const std::vector<std::string>& names,
               const std::vector<std::string>& known) {
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      say(fmt::format("{} {}: must be among {}", option, name, fmt::join(known, ", ")));
      return false;
    }
  return true;
}

std::vector<std::string> feature_names() {
  std::vector<std::string> names;
  for (const speed::Feature& feature : speed::features()) names.push_back(feature.name);
  return names;
}

/// This very program, to start it again.
std::filesystem::path own_program() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error);  // empty where the system does not tell
}

}  // namespace

int bench(const BenchArguments& arguments) {
  if (!are_known("--methods", arguments.methods, cloth::integrator_names()) ||
      !are_known("--features", arguments.features, feature_names()) ||
      !are_known("--only", arguments.only, speed::speed_parts()))
    return bad_input;
  listen_for_stop();
  cloth::ResultFolder folder;
  if (!arguments.folder.empty())
    if (const auto error = folder.claim(arguments.folder, {.kind = "bench", .files = {"bench.json"}}))
      return report(*error);
  speed::SpeedReport result;
  {
    Progress bar;
    result = speed::study_speed({.parts = arguments.only,
                                 .sizes = arguments.sizes,
                                 .methods = arguments.methods,
                                 .features = arguments.features,
                                 .threads = arguments.threads,
                                 .repeats = arguments.repeats,
                                 .quick = arguments.quick,
                                 .program = own_program(),
                                 .progress = [&](double fraction, const std::string& text) {
                                   bar.show(fraction, text);
                                   return !stop_is_requested();
                                 }});
  }
  const std::string json = speed::speed_json(result);
  std::optional<cloth::IoError> failure;
  if (folder.is_open()) failure = folder.finish("bench.json", json);
  const int printed = print(arguments.json       ? json
                            : arguments.markdown ? speed::speed_markdown(result)
                                                 : speed::speed_text(result));
  if (failure) return report(*failure);  // what took so long is shown all the same
  if (printed != done) return printed;
  if (!result.reference_agrees()) {
    say(fmt::format(
        "semi-implicit Euler and the reference kernel are {:.3g} m apart: the times are not to be "
        "compared",
        result.disagreement));
    return diverged;
  }
  return result.complete ? done : interrupted;
}

}  // namespace clothlab::cli
