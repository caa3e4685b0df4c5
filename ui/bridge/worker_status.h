// What the window shows of the worker besides the cloth and the curves.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "simulation/outcome.h"

namespace clothlab {

struct WorkerStatus {
  bool playing = false;
  double time = 0;  ///< s
  std::int64_t step = 0;
  double time_step = 0;  ///< s
  double speed = 1;      ///< simulated seconds per second asked for
  double steps_per_second = 0, real_time_factor = 0;
  std::optional<cloth::Divergence> divergence;
  std::string notice;   ///< e.g. a rate that the pins make unreachable
  std::string refusal;  ///< why the last scene or edit is not in force
  bool recording = false;
  std::filesystem::path recording_folder;
  std::int64_t recorded_rows = 0;
  std::string recording_error;
  std::int64_t lost_samples = 0;  ///< chart points dropped because the window did not fetch them
};

}  // namespace clothlab
