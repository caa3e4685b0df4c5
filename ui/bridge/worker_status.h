// The worker's state that the window shows besides frames and samples.
#pragma once

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compare/ranking.h"
#include "scene/scene.h"
#include "simulation/outcome.h"

namespace clothlab {

/// Something that was done to the cloth during the run.
struct HistoryMark {
  enum class Kind { pull, gust, pins, edit } kind = Kind::edit;
  double from = 0, to = 0;  ///< s
  std::string what;         ///< of an edit, the parameter's label
  bool operator==(const HistoryMark&) const = default;
};

/// The part of the run that can be gone back to.
struct HistoryStatus {
  std::int64_t last_step = 0;            ///< of a comparison the number of its last common time
  double last_time = 0;                  ///< s
  std::size_t states = 0;                ///< stored states; steps between them are computed again
  std::size_t bytes = 0, max_bytes = 0;  ///< of a comparison for all panes together
  std::shared_ptr<const std::vector<HistoryMark>> marks;  ///< in order; null: none
};

struct WorkerStatus {
  // --- Of any run, of one scene or of a comparison ---

  bool playing = false;
  double time = 0;                ///< s; of a comparison the common time that all panes have reached
  std::int64_t step = 0;          ///< of a comparison the number of that common time
  double speed = 1;               ///< simulated seconds per second asked for
  double real_time_factor = 0;    ///< simulated seconds per second, measured
  std::string refusal;            ///< why the last scene, comparison or edit was refused; empty: it was not
  std::int64_t lost_samples = 0;  ///< chart points dropped because the window did not fetch them
  std::uint64_t commands = 0;     ///< number of commands that were carried out or replaced by a later one

  bool recording = false;
  std::filesystem::path recording_folder;
  std::int64_t recorded_rows = 0;
  std::string recording_error;

  HistoryStatus history;
  bool playing_again = false;  ///< replaying the history rather than computing new steps
  /// How often the worker itself has changed time or scene: by going back or forth, opening a session, or
  /// returning from a divergence.
  std::int64_t jumps = 0;
  /// What the worker runs; the pointer changes with the content. A document adopts it once `commands` shows
  /// that none of its own edits is still waiting. One pane for a scene.
  std::shared_ptr<const cloth::Comparison> comparison;

  // --- Of one scene ---

  double time_step = 0;  ///< s
  double steps_per_second = 0;
  std::optional<cloth::Divergence> divergence;
  std::int64_t divergences = 0;  ///< how often a run has diverged
  std::string notice;  ///< e.g. a rate that the pins make unreachable, or an energy that is not accounted for
  std::string session_error;  ///< why the last session could not be saved, opened or replayed
  std::optional<bool>
      session_agrees;  ///< at the end of an opened session: whether the replayed state agrees to the bit

  // --- Of a comparison ---

  double duration = 0;  ///< s
  int threads = 1;
  std::vector<cloth::PaneResult> panes;  ///< one for each pane
  std::string reference;                 ///< name of the reference, to be displayed
  std::string reference_failure;         ///< why the reference stopped; empty: it did not
  std::optional<double> floor;           ///< m, see cloth::LockStep::floor
  std::int64_t starts = 0;               ///< how often a run began
  std::int64_t new_starts = 0;           ///< how often an edit made the run start again

  /// Whether it plays more slowly than asked for, and than real time.
  bool is_behind() const {
    return playing && real_time_factor > 0 && real_time_factor < 0.9 * std::min(speed, 1.0);
  }
  bool is_comparison() const { return comparison && comparison->panes.size() > 1; }
};

}  // namespace clothlab
