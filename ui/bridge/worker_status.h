// What the window shows of the worker besides the cloth and the curves.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "bridge/recording_status.h"
#include "scene/scene.h"
#include "simulation/outcome.h"

namespace clothlab {

/// What can be gone back to.
struct HistoryStatus {
  std::int64_t first_step = 0, last_step = 0;
  double first_time = 0, last_time = 0;  ///< s
  std::size_t states = 0;                ///< kept; steps between them are computed again
  std::size_t bytes = 0, most_bytes = 0;
};

struct WorkerStatus : RecordingStatus {
  bool playing = false;
  double time = 0;  ///< s
  std::int64_t step = 0;
  double time_step = 0;  ///< s
  double speed = 1;      ///< simulated seconds per second asked for
  double steps_per_second = 0, real_time_factor = 0;
  std::optional<cloth::Divergence> divergence;
  std::string notice;             ///< e.g. a rate that the pins make unreachable, or an energy that is not accounted for
  std::string refusal;            ///< why the last scene or edit is not in force
  std::int64_t lost_samples = 0;  ///< chart points dropped because the window did not fetch them

  std::uint64_t commands = 0;  ///< sent so far that are carried out, or were overtaken by a later one

  HistoryStatus history;
  bool playing_again = false;          ///< what the history has, rather than something new
  std::string session_error;           ///< why the last session was not saved, opened or gone through
  std::optional<bool> session_agrees;  ///< at an opened session's end: whether it came out to the bit
  /// How often the worker itself has changed time or scene: by going back or forth, opening a session, or
  /// returning from a divergence.
  std::int64_t jumps = 0;
  /// In force; another pointer when it is another scene. A document takes it up once `commands` says that no
  /// edit of its own is on the way.
  std::shared_ptr<const cloth::Scene> scene;
};

}  // namespace clothlab
