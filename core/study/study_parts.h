// A study that several processes make, each a part of it in a folder of its own: what the parts have, as one.
//
//     StudyParts parts(plan, shard);
//     for (const auto& place : part_folders(folder))
//       parts.add(read_study(place).study->table, place.string());
//     if (parts.disagreements().empty()) use(parts.table());
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/shard.h"
#include "study/study_folder.h"

namespace cloth {

/// FOLDER/shards/2-of-3: where a process makes its part of the study in FOLDER.
std::filesystem::path part_folder(const std::filesystem::path& folder, const Shard& shard);

/// Those that there are, by name, whatever the number of shards was when they were made.
std::vector<std::filesystem::path> part_folders(const std::filesystem::path& folder);

class StudyParts {
 public:
  /// `plan` is the study without its results; `shard` has the cells that are wanted; none: all are.
  StudyParts(const StudyTable& plan, const std::optional<Shard>& shard);

  /// Takes the cells that are not there yet. One that is there must be the same in all but times; of work and
  /// precision the run that was timed more often keeps its times. `maker`: names the part to people.
  /// Precondition: a part of the same study.
  void add(const StudyTable& part, const std::string& maker);

  /// What all have together, not complete even where no cell is missing.
  const StudyTable& table() const { return table_; }

  /// Cells that two parts came to different results of, the first hundred: what differs, and both makers.
  const std::vector<std::string>& disagreements() const { return disagreements_; }

 private:
  using Results = std::vector<std::pair<std::string, std::string>>;  ///< names and texts

  bool wants(std::int64_t number) const { return !shard_ || shard_->has(number); }
  void take(std::int64_t cell) { makers_of_[cell] = makers_.size() - 1; }
  void compare(std::int64_t cell, const std::string& name, const Results& there, const Results& here);

  template <class Cell, class Number, class Name, class Words>
  void join_cells(std::vector<Cell>& into, const std::vector<Cell>& from, Number number, Name name,
                  Words words);
  void join(ExtremesTable& into, const ExtremesTable& from);
  void join(GridConvergence& into, const GridConvergence& from);
  void join(ValidationStudy& into, const ValidationStudy& from);
  void join(StabilityMap& into, const StabilityMap& from);
  void join_limits(StabilityMap& into, const StabilityMap& from, std::size_t method);
  void join(WorkPrecision& into, const WorkPrecision& from);
  void join(IterationsStudy& into, const IterationsStudy& from);
  void join_reference(ReferenceSolution& into, const ReferenceSolution& from);

  StudyTable table_;
  std::optional<Shard> shard_;
  std::vector<std::string> makers_, disagreements_;
  std::map<std::int64_t, std::size_t> makers_of_;  ///< of each cell, by a number of its own
};

}  // namespace cloth
