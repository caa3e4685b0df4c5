// What the window of a comparison shows besides the cloths, and the points of its charts.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bridge/recording_status.h"
#include "compare/ranking.h"

namespace clothlab {

/// One pane at one common time; NaN is what it does not have, as after it stopped.
struct PaneSample {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double total_J = none;
  double max_strain = none;  ///< a fraction
  double step_ms = none;     ///< mean of the steps since the common time before
  double rms_m = none;       ///< from the reference
};

struct CompareSample {
  double time_s = 0;
  bool is_start = false;                            ///< of a new run: what came before belongs to another
  std::array<PaneSample, cloth::most_panes> panes;  ///< by style_of(pane): A, B, C, D, whatever their order
};

struct CompareStatus : RecordingStatus {
  bool playing = false;
  double time = 0;  ///< s, the common time that all panes have reached
  double duration = 0;
  double speed = 1;             ///< simulated seconds per second asked for
  double real_time_factor = 0;  ///< as it goes
  int threads = 1;

  std::shared_ptr<const cloth::Comparison> comparison;  ///< in force
  std::vector<cloth::PaneResult> panes;                 ///< one of each pane
  std::string reference;                                ///< what differences are from, for people
  std::string reference_failure;                        ///< not empty: the reference stopped, and why
  std::optional<double> floor;                          ///< m, see cloth::LockStep::floor
  std::string refusal;                                  ///< why the last comparison or edit is not in force
  std::int64_t new_starts = 0;  ///< how often an edit could not be put in force in the middle of the run

  std::int64_t lost_samples = 0;  ///< chart points dropped because the window did not fetch them
};

}  // namespace clothlab
