// What a comparison leaves in its folder: a recording of each pane (A.csv, ...), compare.csv, a row for each
// common time, and edits.jsonl if something was done to it meanwhile. The window and the command line write
// the same.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "compare/lockstep.h"
#include "io/csv.h"
#include "io/result_folder.h"

namespace cloth {

/// The columns of compare.csv: time_s, then for each pane A_total_J, A_energy_error_J, A_max_strain,
/// A_limiter_excess?, A_contacts?, A_step_time_us, A_rms_difference_m?, A_largest_difference_m?; and
/// reference_floor_m? of a controlled reference.
std::vector<std::string> comparison_columns(const LockStep& lockstep);

/// One row at the last compare(). Fields of a pane that has stopped are empty, and so are differences that
/// there are not.
std::vector<std::string> comparison_row(const LockStep& lockstep);

class ComparisonRecorder {
 public:
  /// Claims the folder, writes comparison.json and begins the files; `lockstep` is at a common time.
  std::optional<IoError> open(const std::filesystem::path& folder, const LockStep& lockstep);

  /// In a folder that is claimed and outlives the recorder.
  std::optional<IoError> open(ResultFolder& folder, const LockStep& lockstep);

  /// A row of each pane that is going, and one of compare.csv. Where an edit gave a pane other quantities, or
  /// other panes, all files go on in a next part (A-2.csv, ..., compare-2.csv).
  std::optional<IoError> add_row(const LockStep& lockstep);

  /// Lines of edits.jsonl (see comparison_log.h).
  std::optional<IoError> log(const std::vector<std::string>& lines);

  std::optional<IoError> flush();
  /// A folder that was not claimed before gets a summary.json that lists its files.
  std::optional<IoError> close();

 private:
  std::optional<IoError> open_part(const LockStep& lockstep);
  std::optional<IoError> close_rows();

  ResultFolder own_folder_;
  ResultFolder* folder_ = &own_folder_;
  int part_ = 0;
  std::string reference_;
  std::vector<std::string> names_;      ///< of the panes
  std::vector<Quantities> quantities_;  ///< one of each pane
  std::vector<std::unique_ptr<CsvFile>> panes_;
  std::unique_ptr<CsvFile> compare_;
  LineFile edits_;  ///< open once there is a line
};

/// What a comparison's folder is used for; its reports come after the recording.
FolderUse comparison_use(const Comparison& comparison);

/// The comparison as it is run: steps resolved, so that running it again gives the same rows.
Comparison as_run(const LockStep& lockstep);

}  // namespace cloth
