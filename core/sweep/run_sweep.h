// Makes the points of a sweep that its folder does not have yet.
//
//     const SweepRun run = run_sweep(*take_sweep_folder("out", plan).folder, {.jobs = 4});
#pragma once

#include <functional>

#include "study/study_progress.h"
#include "sweep/sweep_folder.h"

namespace cloth {

struct SweepRunOptions {
  int jobs = 1;  ///< points that are run at once, each on a thread of its own
  Shard shard{};
  StopTest stop{};
  /// Called some ten times a second by the calling thread: points of the shard that are there, and all.
  std::function<void(std::int64_t done, std::int64_t of)> progress{};
  /// Called with every row that is on its way to the disk, by any thread, one at a time.
  std::function<void(const PointRow&)> row{};
};

struct SweepRun {
  std::int64_t points = 0;   ///< of the shard
  std::int64_t earlier = 0;  ///< that were there
  std::int64_t made = 0;     ///< now
  bool stopped = false;
  std::optional<IoError> error{};  ///< what was written before it is valid

  bool is_complete() const { return earlier + made == points; }
};

/// Every row is written when its point ends, so that a process that is killed loses the points it was at, and
/// is waited for until it is on the disk. Files of all earlier attempts are read first, whatever their
/// shards.
SweepRun run_sweep(const SweepFolder& folder, const SweepRunOptions& options);

}  // namespace cloth
