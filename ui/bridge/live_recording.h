// Writes a recording while the window runs: the same files and rows as clothlab-cli run, and the log of
// edits. Used by the worker's thread. Functions that write return the error, or nullopt.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "simulation/recorder.h"
#include "simulation/session.h"

namespace clothlab {

class LiveRecording {
 public:
  LiveRecording() = default;
  LiveRecording(const LiveRecording&) = delete;
  LiveRecording& operator=(const LiveRecording&) = delete;

  /// Begins in `folder` at the simulation's present state and writes the first row. If that state is later
  /// than step 0, it is saved as start_state.csv.
  std::optional<cloth::IoError> begin(const std::filesystem::path& folder,
                                      const cloth::Simulation& simulation);

  bool is_active() const { return active_; }
  const std::filesystem::path& folder() const { return folder_.path(); }
  std::int64_t rows() const { return rows_; }

  /// Writes a row; the `steps` steps since the previous row took `wall` seconds. If the scene's stages have
  /// changed since then, a new file (record-2.csv, ...) with the new columns is begun.
  std::optional<cloth::IoError> add_row(const cloth::Simulation& simulation,
                                        const cloth::Measurement& measurement, double wall,
                                        std::int64_t steps);

  /// Writes one line to edits.jsonl for each value that the command sets.
  std::optional<cloth::IoError> log(const cloth::SessionCommand& command);

  /// Flushes the files if `now` is true or the last flush was more than half a second ago.
  std::optional<cloth::IoError> keep_current(bool now);

  /// Ends the recording: writes final_state.csv (of `last_good`) and summary.json, unless an earlier write
  /// failed.
  std::optional<cloth::IoError> end(const cloth::Simulation& simulation, const cloth::ClothState& last_good,
                                    const std::optional<cloth::Divergence>& divergence);

 private:
  cloth::ResultFolder folder_;
  cloth::RecordFile record_;
  cloth::LineFile edits_;
  bool active_ = false;
  std::int64_t rows_ = 0, first_step_ = 0;
  cloth::StepCount first_count_;
  double first_time_ = 0, wall_ = 0, max_strain_ = 0, limiter_excess_ = 0;
  cloth::EnergyAccount energy_;
  std::chrono::steady_clock::time_point last_flush_;
};

}  // namespace clothlab
