// A study's folder while the study is made: each finished cell is in its table on disk before its thread
// begins another, and a study that was stopped or killed goes on from there. Rows are in the order in which
// cells ended, until the study ends or goes on: then in the study's own. Several processes may make a part
// each, in folders of their own within it (study_parts.h); whoever makes the whole study takes what they
// have.
//
//     StudyRecorder recorder;
//     if (auto error = recorder.begin(folder, plan_stability_map(scene, options), {.command = command})) ...
//     options.earlier = std::get_if<StabilityMap>(recorder.earlier());
//     options.partial = [&](const StabilityMap& map) { failure = recorder.keep(map); };
//     const StabilityMap map = run_stability_map(scene, options);
//     if (auto error = recorder.end(map, wall)) ...
#pragma once

#include <set>

#include "io/csv.h"
#include "io/result_folder.h"
#include "study/study_parts.h"

namespace cloth {

inline constexpr const char* samples_name = "work_precision_samples.csv";

struct StudyStart {
  std::string command{};                        ///< what makes the study
  std::vector<std::filesystem::path> inputs{};  ///< that it reads, beside the scene's meshes
  bool overwrite = false;                       ///< begin anew where an unfinished study lies
  /// Make this part alone, in a folder of its own; it is also to be that of the study's options.
  std::optional<Shard> shard{};
};

class StudyRecorder {
 public:
  /// Takes the folder for the study that `plan` is without its results. An unfinished study there goes on
  /// where kind, scene, options, version and instruction set are the same (times: the processor too), and is
  /// refused where they are not, unless it may be overwritten. A finished one is made anew. The same holds
  /// for the parts of it that lie there: what they have is taken, where they agree; nothing is to be
  /// overwritten.
  std::optional<IoError> begin(const std::filesystem::path& folder, const StudyTable& plan,
                               const StudyStart& start);

  /// The unfinished study that goes on, with what parts have; null if there is none.
  const StudyTable* earlier() const { return earlier_ ? &earlier_->table : nullptr; }

  /// How many parts there are, and the cells that they do not agree on: then begin() has refused them.
  int parts() const { return parts_; }
  const std::vector<std::string>& disagreements() const { return disagreements_; }

  /// Where this study or part is made.
  const std::filesystem::path& path() const { return folder_.path(); }

  /// Appends what `so_far` has beyond the last call. From one thread at a time.
  std::optional<IoError> keep(const StudyTable& so_far);
  std::optional<IoError> keep(const WorkPrecision& so_far);
  std::optional<IoError> keep(const StabilityMap& so_far);
  std::optional<IoError> keep(const ExtremesTable& so_far);
  std::optional<IoError> keep(const GridConvergence& so_far);
  std::optional<IoError> keep(const ValidationStudy& so_far);
  std::optional<IoError> keep(const IterationsStudy& so_far);

  /// Tables, picture and page, and study.json after them; of a part tables and study.json. `wall`: s since
  /// begin().
  std::optional<IoError> end(const StudyTable& table, double wall);

  bool is_open() const { return folder_.is_open(); }

  /// A whole study at once, in place of whatever study the folder holds. study.json comes last and has the
  /// digests of the other files: whenever the writing ends, the folder holds this study or none.
  static std::optional<IoError> write(const std::filesystem::path& folder, const StudyTable& table,
                                      const std::string& command, double wall);

 private:
  struct Unfinished;

  std::optional<IoError> look_at_earlier(const StudyTable& plan);
  std::optional<IoError> take_parts(const std::filesystem::path& folder, const StudyTable& plan,
                                    const StudyStart& start);
  std::optional<IoError> read_unfinished(const std::filesystem::path& place, const StudyTable& plan,
                                         Unfinished& found) const;
  std::optional<IoError> begin_tables(const StudyTable& plan);
  std::optional<IoError> end_part(const StudyTable& table, double wall);
  std::optional<IoError> write_index(const StudyTable& so_far);

  ResultFolder folder_;
  std::string command_;
  std::optional<Shard> shard_;
  std::optional<Study> earlier_;
  int parts_ = 0;
  double wall_of_parts_ = 0;  ///< s
  std::vector<std::string> disagreements_;
  CsvFile rows_, samples_;
  std::set<std::int64_t> cells_kept_;                   ///< by number; of the kinds without methods
  std::vector<std::vector<bool>> map_kept_;             ///< of a map, of each method's cells
  std::vector<std::size_t> rows_kept_;                  ///< of each method
  std::vector<std::vector<std::size_t>> samples_kept_;  ///< of each run of each method
  std::size_t limits_kept_ = 0;
  bool step_kept_ = false;            ///< of iterations: study.json says what step is studied
  std::optional<FileDigest> states_;  ///< of the reference, once they are in their file
};

}  // namespace cloth
