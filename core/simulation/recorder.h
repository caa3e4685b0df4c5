// record.csv: which columns a scene has, when a row is due, and a run from start to end.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "io/csv.h"
#include "io/result_folder.h"
#include "simulation/run_summary.h"
#include "simulation/simulation.h"

namespace cloth {

/// The columns of record.csv for these quantities, in the file's order.
std::vector<std::string> record_columns(const Quantities& quantities);

/// One row. `step_time` in s: mean wall time of a step since the row before.
std::vector<std::string> record_row(const Measurement& measurement, const Quantities& quantities,
                                    double step_time);

/// The number that record.csv has in a column, not a number where its cell is empty; nullopt where it has no
/// such column of these quantities, and for step_time_us, which is of the machine.
std::optional<double> recorded_value(const std::string& column, const Measurement& measurement,
                                     const Quantities& quantities);

/// When a row is due: every `stride` steps from `origin`.
struct RowClock {
  std::int64_t origin = 0, stride = 1;
  std::int64_t first_step = 0;   ///< at which the time step that the stride is of came in force
  bool within_interval = false;  ///< it did so between two rows
  static RowClock of(const Simulation& simulation);
  bool due(std::int64_t step) const {
    return until_due(step) == stride && !(within_interval && step == origin);
  }
  /// Steps from `step` to the next row, at least 1.
  std::int64_t until_due(std::int64_t step) const { return stride - (step - origin) % stride; }
  /// After an edit, or where "auto" has shortened the step: counts from where that was.
  void follow(const Simulation& simulation);
};

/// record.csv; where the scene's stages change within a run, record-2.csv, ... go on with the new columns.
class RecordFile {
 public:
  /// In a folder that is claimed and outlives the file.
  std::optional<IoError> open(ResultFolder& folder, const Quantities& quantities);

  /// `step_time` in s: mean wall time of a step since the row before.
  std::optional<IoError> add(const Measurement& measurement, const Quantities& quantities, double step_time);

  std::optional<IoError> flush() { return csv_.flush(); }
  std::optional<IoError> close();
  bool is_open() const { return csv_.is_open(); }

 private:
  std::optional<IoError> open_part(const Quantities& quantities);

  ResultFolder* folder_ = nullptr;
  CsvFile csv_;
  Quantities quantities_;
  int part_ = 0;
};

struct RunOptions {
  std::filesystem::path folder;  ///< empty: leave nothing on disk
  /// Called some ten times a second with the simulated time; false stops the run.
  std::function<bool(double time)> progress;
  /// Called with every row of the recording, whether it is written or not.
  std::function<void(const Simulation& simulation, const Measurement& row)> row{};
  int threads = 1;                              ///< that a step may use
  std::vector<std::filesystem::path> inputs{};  ///< files that the folder must not replace, beside the meshes
};

struct RunResult {
  RunSummary summary;
  std::optional<IoError> io_error;  ///< what was written before it is valid
  ClothState final_state;           ///< the last good one
};

/// The names of the files that a run leaves in its folder.
const std::vector<std::string>& run_files();

/// Runs a scene to its duration. Precondition: as for Simulation.
RunResult run_scene(const Scene& scene, const RunOptions& options);

/// What the geometry says about a rate that cannot be kept.
std::string describe(const UnreachableRate& unreachable, const ClothSystem& system);

}  // namespace cloth
