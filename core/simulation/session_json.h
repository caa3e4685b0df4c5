// Sessions as JSON (docs/sessions.md): reading with every problem at once, writing; and the lines of
// edits.jsonl.
#pragma once

#include "simulation/session.h"

namespace cloth {

inline constexpr const char* session_format = "clothlab/session/1";

/// A session, or why there is none. Exactly one of the two is there.
struct SessionReading {
  std::optional<Session> session;
  std::vector<Problem> problems;
};

/// `place` names the text in messages; its folder is that of meshes, if no other is given. Whether the
/// commands fit the scene at their time only a replay can tell.
SessionReading read_session(const std::string& text, const std::string& place,
                            const std::optional<SceneFolder>& folder = {});

/// Numbers read back to the same bits.
std::string write_session(const Session& session);

/// Puts problems of `carry_out` for the command of this number at their places in the session's text.
void place_in_session(const std::string& text, const std::string& place, std::size_t command,
                      std::vector<Problem>& problems);

/// What an action sets, with values as JSON: parameters, "brush" or "pull" ("null": let go).
std::vector<SceneEdit> logged_values(const SessionAction& action);

/// {"step":...,"time_s":...,"path":...,"value":...}, one for each value that the command sets.
std::vector<std::string> edit_log_lines(const SessionCommand& command);

}  // namespace cloth
