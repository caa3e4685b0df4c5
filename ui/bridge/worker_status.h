// What the windows show of their workers besides the cloths and the curves.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compare/ranking.h"
#include "scene/scene.h"
#include "simulation/outcome.h"

namespace clothlab {

/// Of any run, of one simulation or of a comparison.
struct RunStatus {
  bool playing = false;
  double time = 0;                ///< s; of a comparison the common time that all panes have reached
  double speed = 1;               ///< simulated seconds per second asked for
  double real_time_factor = 0;    ///< as it goes
  std::string refusal;            ///< why the last scene, comparison or edit is not in force
  std::int64_t lost_samples = 0;  ///< chart points dropped because the window did not fetch them

  bool recording = false;
  std::filesystem::path recording_folder;
  std::int64_t recorded_rows = 0;
  std::string recording_error;
};

/// What can be gone back to.
struct HistoryStatus {
  std::int64_t first_step = 0, last_step = 0;
  double first_time = 0, last_time = 0;  ///< s
  std::size_t states = 0;                ///< kept; steps between them are computed again
  std::size_t bytes = 0, most_bytes = 0;
};

struct WorkerStatus : RunStatus {
  std::int64_t step = 0;
  double time_step = 0;  ///< s
  double steps_per_second = 0;
  std::optional<cloth::Divergence> divergence;
  std::string notice;  ///< e.g. a rate that the pins make unreachable, or an energy that is not accounted for
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

struct CompareStatus : RunStatus {
  double duration = 0;  ///< s
  int threads = 1;
  std::shared_ptr<const cloth::Comparison> comparison;  ///< in force
  std::vector<cloth::PaneResult> panes;                 ///< one of each pane
  std::string reference;                                ///< what differences are from, for people
  std::string reference_failure;                        ///< not empty: the reference stopped, and why
  std::optional<double> floor;                          ///< m, see cloth::LockStep::floor
  std::int64_t new_starts = 0;  ///< how often an edit could not be put in force in the middle of the run
};

}  // namespace clothlab
