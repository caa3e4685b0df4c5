// A session is a value: a scene as it was started, and everything that was done to it while it ran, with the
// step before which it was done. Carried out again it gives the same bits, in the window or without.
//
//     const SessionReading reading = read_session(text, "pull.session.json");
//     const ReplayResult result = replay(*reading.session, {});
//     result.run.final_state;  result.agrees;
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scene/scene_edits.h"
#include "simulation/recorder.h"
#include "simulation/simulation.h"

namespace cloth {

/// What a command does; the absence of a gust or a pull lets go.
using Edits = std::vector<SceneEdit>;  ///< put in force together
using SessionAction = std::variant<Edits, std::optional<BrushGust>, std::optional<Pull>>;

struct SessionCommand {
  std::int64_t step = 0;  ///< done after this step, before the next one
  double time = 0;        ///< s, then; for people, not for replays
  SessionAction action;
};

struct Session {
  Scene scene;                                ///< as it was started
  std::vector<SessionCommand> commands = {};  ///< steps ascend, from 0 to `steps`
  std::int64_t steps = 0;
  double time = 0;                    ///< s, at the end; for people
  std::string final_state_hash = {};  ///< state_hash at the end, after its last commands; empty: not known
  std::string version = {};           ///< of the program that wrote it
  std::vector<StepChange> step_changes = {};  ///< where "auto" shortened the step; a replay finds the same
};

/// Of positions, velocities, time and step: equal where every bit is, and 16 hexadecimal digits.
std::string state_hash(const ClothState& state);

/// Carries out a command. An edit that does not fit the scene in force, and a hand where there is no
/// particle, are problems, with paths as in a session file ("set.springs.shear", "pull.particle"); then
/// nothing has been done.
std::vector<Problem> carry_out(const SessionAction& action, Simulation& simulation);

/// True if there is nothing to do: an edit without a change, letting go of what is not held. Carrying it out
/// could still change later bits, because methods forget what they remember: it is better left.
bool is_idle(const SessionAction& action, const Simulation& simulation);

struct ReplayOptions {
  std::filesystem::path folder;  ///< as for RunOptions
  double until =
      std::numeric_limits<double>::infinity();  ///< s: ends at the step nearest to it, if that is earlier
  std::function<bool(double time)> progress;    ///< as for RunOptions
  std::vector<std::filesystem::path> inputs{};  ///< as for RunOptions
};

struct ReplayResult {
  RunResult run;
  std::size_t commands = 0;       ///< carried out
  std::vector<Problem> problems;  ///< of the next one, which could not be carried out: it ended the replay
  std::optional<bool> agrees;  ///< the final state with the session's hash; nothing without an end or a hash
};

/// Carries a session out to its end. Precondition of its scene: as for Simulation.
ReplayResult replay(const Session& session, const ReplayOptions& options);

}  // namespace cloth
