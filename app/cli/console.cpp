#include "console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "contact/start_check.h"
#include "io/printable.h"
#include "io/process.h"
#include "scene/builtin_scenes.h"
#include "simulation/memory_estimate.h"

namespace clothlab::cli {

void write_error(const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t part = ::write(STDERR_FILENO, text.data() + done, text.size() - done);
    if (part < 0 && errno != EINTR) return;  // standard error is closed
    if (part > 0) done += static_cast<std::size_t>(part);
  }
}

void say(const std::string& message) {
  write_error(fmt::format("{}: {}\n", program_name, cloth::printable(message)));
}

int report(const std::vector<cloth::Problem>& problems) {
  constexpr std::size_t most = 100;  // a file of a million errors is not read to its end
  std::string text;
  for (std::size_t k = 0; k < std::min(problems.size(), most); ++k)
    text += cloth::printable(problems[k].text()) + "\n";
  if (problems.size() > most) text += fmt::format("and {} more\n", problems.size() - most);
  write_error(text);
  return bad_input;
}

int report(const cloth::IoError& error) {
  say(error.text());
  return error.refused ? bad_input : io_failed;
}

namespace {

int print_bytes(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0)
    return done;
  say(fmt::format("standard output: {}", std::strerror(errno)));
  return io_failed;
}

}  // namespace

int print(const std::string& text) {
  return print_bytes(cloth::printable_lines(text));
}

std::string summary_text(const cloth::RunSummary& s, const std::string& folder) {
  std::string text = fmt::format(
      "{}: {}, {} steps of {:.6g} s, {:.6g} s simulated in {:.3g} s ({:.3g} ns per particle and step)\n"
      "largest strain {:.4g} %, energy error {:.3g} J at the end, at most {:.2g} % of the energy exchanged\n",
      cloth::name_of(s.status), s.method, s.count.steps, s.time_step, s.simulated, s.wall,
      s.nanoseconds_per_particle_step(), 100 * s.max_strain, s.energy.error(), 100 * s.energy.share());
  if (!folder.empty()) text += fmt::format("results in {}\n", folder);
  return text;
}

void say_what_went_wrong(const cloth::RunSummary& summary) {
  if (!summary.notice.empty()) say(summary.notice);
  if (!summary.step_changes.empty()) say(cloth::describe(summary.step_changes));
  if (summary.divergence) say(cloth::describe(*summary.divergence));
}

int exit_code_of(const cloth::RunSummary& summary) {
  if (summary.status == cloth::Status::diverged) return diverged;
  if (summary.status == cloth::Status::stopped) return interrupted;
  return summary.rate_breach ? rate_not_kept : done;
}

std::optional<std::vector<cloth::Override>> parse_settings(const std::vector<std::string>& settings) {
  std::vector<cloth::Override> overrides;
  for (const std::string& setting : settings) {
    const auto parsed = cloth::parse_override(setting);
    if (!parsed) {
      say(fmt::format("--set {}: must be PATH=VALUE, for example springs.structural=500", setting));
      return std::nullopt;
    }
    overrides.push_back(*parsed);
  }
  return overrides;
}

int refused_for_memory(cloth::Scene scene, const std::vector<std::string>& methods) {
  std::optional<std::string> problem;
  if (methods.empty()) problem = cloth::memory_problem(scene);
  for (const std::string& method : methods) {
    scene.integrator.method = method;
    if (!problem) problem = cloth::memory_problem(scene);
  }
  if (!problem) return done;
  say(*problem);
  return io_failed;
}

int run_program(const std::function<int()>& command) {
  cloth::settle_standard_streams();
  cloth::end_by_exit_code(program_name, io_failed, defect);
  try {
    return command();
  } catch (...) {
    const cloth::Failure failure = cloth::failure_in_hand();
    say(failure.text);
    return failure.is_defect ? defect : io_failed;
  }
}

NamedText read_named(const std::string& name, const std::string* built_in, const char* what,
                     const char* lister) {
  std::error_code error;
  NamedText found;
  found.is_file =
      std::filesystem::exists(name, error) && !(built_in && std::filesystem::is_directory(name, error));
  if (found.is_file) {
    if (const auto failure = cloth::read_text_file(name, found.text)) found.exit_code = report(*failure);
  } else if (built_in) {
    found.text = *built_in;
  } else {
    say(
        fmt::format("{}: there is neither a file nor a built-in {} of this name; 'clothlab-cli {}' lists the "
                    "built-in ones",
                    name, what, lister));
    found.exit_code = io_failed;
  }
  return found;
}

LoadedScene load_scene(const std::string& name, const std::vector<std::string>& settings) {
  const auto overrides = parse_settings(settings);
  if (!overrides) return {std::nullopt, bad_input};
  const cloth::BuiltinScene* builtin = cloth::find_builtin_scene(name);
  const auto [text, is_file, exit_code] =
      read_named(name, builtin ? &builtin->text : nullptr, "scene", "scenes");
  if (exit_code != done) return {std::nullopt, exit_code};
  cloth::MeshSource meshes;
  if (!is_file) meshes.folder = cloth::SceneFolder{.path = "", .built_in = true};
  cloth::SceneReading reading = cloth::read_runnable_scene(text, name, *overrides, meshes);
  if (!reading.scene) return {std::nullopt, report(reading.problems)};
  return {std::move(reading.scene), done};
}

}  // namespace clothlab::cli
