// A study's folder while the study is made: each finished cell is in its table on disk before the next
// begins, and a study that was stopped or killed goes on from there.
//
//     StudyRecorder recorder;
//     if (auto error = recorder.begin(folder, plan_stability_map(scene, options), {.command = command})) ...
//     options.earlier = std::get_if<StabilityMap>(recorder.earlier());
//     options.partial = [&](const StabilityMap& map) { failure = recorder.keep(map); };
//     const StabilityMap map = run_stability_map(scene, options);
//     if (auto error = recorder.end(map, wall)) ...
#pragma once

#include "io/csv.h"
#include "io/result_folder.h"
#include "study/study_folder.h"

namespace cloth {

inline constexpr const char* samples_name = "work_precision_samples.csv";

struct StudyStart {
  std::string command{};                        ///< what makes the study
  std::vector<std::filesystem::path> inputs{};  ///< that it reads, beside the scene's meshes
  bool overwrite = false;                       ///< begin anew where an unfinished study lies
};

class StudyRecorder {
 public:
  /// Takes the folder for the study that `plan` is without its results. An unfinished study there goes on
  /// where kind, scene, options, version and instruction set are the same (times: the processor too), and is
  /// refused where they are not, unless it may be overwritten. A finished one is made anew.
  std::optional<IoError> begin(const std::filesystem::path& folder, const StudyTable& plan,
                               const StudyStart& start);

  /// The unfinished study that goes on; null if there is none.
  const StudyTable* earlier() const { return earlier_ ? &earlier_->table : nullptr; }

  /// Appends what `so_far` has beyond the last call, in the order in which it was run.
  std::optional<IoError> keep(const StudyTable& so_far);
  std::optional<IoError> keep(const WorkPrecision& so_far);
  std::optional<IoError> keep(const StabilityMap& so_far);
  std::optional<IoError> keep(const ExtremesTable& so_far);
  std::optional<IoError> keep(const GridConvergence& so_far);
  std::optional<IoError> keep(const ValidationStudy& so_far);
  std::optional<IoError> keep(const IterationsStudy& so_far);

  /// Tables, picture and page, and study.json after them. `wall`: s of this part of the study.
  std::optional<IoError> end(const StudyTable& table, double wall);

  bool is_open() const { return folder_.is_open(); }

  /// A whole study at once, in place of whatever study the folder holds. study.json comes last and has the
  /// digests of the other files: whenever the writing ends, the folder holds this study or none.
  static std::optional<IoError> write(const std::filesystem::path& folder, const StudyTable& table,
                                      const std::string& command, double wall);

 private:
  std::optional<IoError> look_at_earlier(const StudyTable& plan, const StudyStart& start);
  std::optional<IoError> begin_tables(const StudyTable& plan);
  std::optional<IoError> write_index(const StudyTable& so_far);
  void restore_reference(const std::string& index);

  ResultFolder folder_;
  std::string command_;
  std::optional<Study> earlier_;
  CsvFile rows_, samples_;
  std::vector<std::size_t> rows_kept_;                  ///< of each method; the others: of all
  std::vector<std::vector<std::size_t>> samples_kept_;  ///< of each run of each method
  std::size_t limits_kept_ = 0;
  bool step_kept_ = false;            ///< of iterations: study.json says what step is studied
  std::optional<FileDigest> states_;  ///< of the reference, once they are in their file
};

}  // namespace cloth
