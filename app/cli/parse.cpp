#include "parse.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "console.h"
#include "io/machine.h"
#include "io/printable.h"
#include "kernels/instruction_set.h"
#include "simulation/step_batches.h"

namespace clothlab::cli {
namespace {

/// What the parser says, and its exit code: help and the version are asked for, all else is bad usage.
int answer(const CLI::App& app, const CLI::ParseError& error) {
  std::ostringstream output, errors;
  const bool asked_for = app.exit(error, output, errors) == 0;
  write_error(cloth::printable_lines(errors.str()));
  if (const int printed = print(output.str()); printed != done) return printed;
  return asked_for ? done : bad_input;
}

}  // namespace

std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  app.set_version_flag("--version", cloth::version());
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return answer(app, error);
  }
  if (const std::string problem = cloth::instruction_set_problem(); !problem.empty()) {
    say(problem);
    return bad_input;
  }
  return std::nullopt;
}

CLI::Option* add_scene(CLI::App& command, std::string& scene) {
  return command.add_option("scene", scene, "A scene file or the name of a built-in scene");
}

CLI::Option* add_settings(CLI::App& command, std::vector<std::string>& settings) {
  return command
      .add_option("--set", settings,
                  "Set a parameter, PATH=VALUE, e.g. springs.structural=500; null takes a block out, e.g. "
                  "air=null; may be repeated")
      ->allow_extra_args(false);
}

CLI::Option* add_json(CLI::App& command, bool& json) {
  return command.add_flag("--json", json, "Give the result as one JSON object");
}

void add_overwrite(CLI::App& command, bool& overwrite) {
  command.add_flag("--overwrite", overwrite,
                   "Begin anew where the folder holds an unfinished study; without it that goes on if it has "
                   "the same inputs, and is left alone if not");
}

CLI::Option* add_shard(CLI::App& command, std::string& shard, CLI::Option* out) {
  return add_path(
             command, "--shard", shard,
             "I/N: make part I of N alone, into DIR/shards/I-of-N; auto/N and auto as for sweep. The command "
             "without this option then takes what the parts have and makes the rest")
      ->needs(out);
}

CLI::Option* add_jobs(CLI::App& command, int& jobs, const std::string& what) {
  return command
      .add_option("--jobs", jobs, what + "; without it one on each core. The results are the same to the bit")
      ->check(CLI::Range(1, 1024));
}

int chosen_jobs(int jobs) {
  return jobs > 0 ? jobs : cloth::machine_threads();
}

std::variant<std::optional<cloth::Shard>, int> chosen_shard(const std::string& text) {
  if (text.empty()) return std::optional<cloth::Shard>();
  const auto chosen = cloth::shard_from(text, [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value ? value : "");
  });
  if (const auto* problem = std::get_if<cloth::Problem>(&chosen))
    return report(std::vector<cloth::Problem>{*problem});
  return std::optional(std::get<cloth::Shard>(chosen));
}

CLI::Option* add_path(CLI::App& command, const char* option, std::string& path, const std::string& help) {
  return command.add_option(option, path, help)
      ->check(CLI::Validator(
          [](const std::string& name) {
            return name.empty() ? std::string("must be a name") : std::string();
          },
          ""));
}

CLI::Option* add_names(CLI::App& command, const char* option, std::vector<std::string>& names,
                       const std::string& help, const std::vector<std::string>& known) {
  const auto problem = [known](const std::string& name) {
    if (std::find(known.begin(), known.end(), name) != known.end()) return std::string();
    return fmt::format("{}: must be one of {}", name, fmt::join(known, ", "));
  };
  return command.add_option(option, names, help)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Validator(problem, ""));
}

}  // namespace clothlab::cli
