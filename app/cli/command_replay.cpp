#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "console.h"
#include "io/machine.h"
#include "io/text_file.h"
#include "progress.h"
#include "simulation/run_summary.h"
#include "simulation/session_json.h"
#include "simulation/time_step.h"

namespace clothlab::cli {
namespace {

struct ReplayArguments {
  std::string session;
  std::string folder;
  double until = std::numeric_limits<double>::infinity();  ///< s
  bool json = false;
};

/// What the replay's end says of the session's. A difference is told on standard error.
std::string agreement_text(const cloth::Session& session, const cloth::ReplayResult& result) {
  if (result.agrees) return *result.agrees ? "the final state is the session's, to the bit\n" : "";
  if (session.final_state_hash.empty()) return "the session has no hash to compare with\n";
  return fmt::format("not compared: the replay ended at step {} of {}\n", result.run.final_state.step,
                     session.steps);
}

std::string result_text(const cloth::Session& session, const cloth::ReplayResult& result,
                        const std::string& folder) {
  return summary_text(result.run.summary, folder) +
         fmt::format("{} of {} commands carried out\n", result.commands, session.commands.size()) +
         agreement_text(session, result);
}

std::string result_json(const cloth::Session& session, const cloth::ReplayResult& result) {
  nlohmann::ordered_json root = nlohmann::ordered_json::parse(cloth::summary_json(result.run.summary));
  nlohmann::ordered_json& of_session = root["session"];
  of_session = {{"commands", result.commands},
                {"state_hash", cloth::state_hash(result.run.final_state)},
                {"expected_hash", session.final_state_hash}};
  of_session["agrees"] = result.agrees ? nlohmann::ordered_json(*result.agrees) : nullptr;
  return root.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void say_difference(const cloth::Session& session, const cloth::ReplayResult& result) {
  if (result.agrees == false)
    say(fmt::format(
        "the final state is not the session's: its hash is {}, the session's is {}; the session was "
        "written by version {}, this is {}",
        cloth::state_hash(result.run.final_state), session.final_state_hash,
        session.version.empty() ? "unknown" : session.version, cloth::version()));
}

int replay(const ReplayArguments& arguments) {
  std::string text;
  if (const auto error = cloth::read_text_file(arguments.session, text)) return report(*error);
  const cloth::SessionReading reading = cloth::read_session(text, arguments.session);
  if (!reading.session) return report(reading.problems);
  const cloth::Session& session = *reading.session;
  if (!cloth::resolved_time_step(session.scene)) {
    say(cloth::no_stable_step_text(session.scene));
    return bad_input;
  }
  if (const int refused = refused_for_memory(session.scene); refused != done) return refused;

  listen_for_stop();
  cloth::ReplayOptions options{
      .folder = arguments.folder, .until = arguments.until, .progress = {}, .inputs = {arguments.session}};
  cloth::ReplayResult result;
  {
    Progress bar;
    const double end = std::min(session.time, arguments.until);
    options.progress = [&](double time) {
      bar.show(end > 0 ? std::min(1.0, time / end) : 0, fmt::format("t = {:.2f} s", time));
      return !stop_is_requested();
    };
    result = cloth::replay(session, options);
  }
  say_what_went_wrong(result.run.summary);
  say_difference(session, result);
  if (result.run.io_error) return report(*result.run.io_error);
  if (!result.problems.empty()) {
    cloth::place_in_session(text, arguments.session, result.commands, result.problems);
    return report(result.problems);
  }
  const int printed =
      print(arguments.json ? result_json(session, result) : result_text(session, result, arguments.folder));
  if (printed != done) return printed;
  return result.agrees.value_or(true) ? exit_code_of(result.run.summary) : differs;
}

}  // namespace

void add_replay(Program& program) {
  auto [command, arguments] = add_command(
      program, "replay", "Carry out a saved session again and compare its end, to the bit", replay);
  command.add_option("session", arguments.session, "A session file")->required();
  add_path(command, "--out", arguments.folder,
           "Folder for scene.json, record.csv, final_state.csv and summary.json; made if missing");
  command.add_option("--until", arguments.until, "End at the step nearest to this time in s")
      ->check(CLI::NonNegativeNumber);
  add_json(command, arguments.json);
}

}  // namespace clothlab::cli
