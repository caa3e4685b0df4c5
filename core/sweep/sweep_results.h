// What the shard files of a sweep say together: each point once, and whether machines agree.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/csv.h"
#include "sweep/sweep_folder.h"

namespace cloth {

/// A point that two attempts came to different results of.
struct SweepDisagreement {
  std::int64_t point = 0;
  std::string text{};  ///< what differs, with both makers and files
};

struct SweepResults {
  std::int64_t points = 0;           ///< of the plan
  std::vector<PointRow> rows{};      ///< ascending, each point once; those that are there
  std::vector<std::string> hosts{};  ///< of each row
  std::array<std::int64_t, point_statuses> counts{};
  std::size_t attempts = 0;
  std::int64_t twice = 0;                          ///< points that more than one attempt made
  std::int64_t damaged = 0;                        ///< lines of files that are no rows
  std::vector<SweepDisagreement> disagreements{};  ///< the first hundred

  std::int64_t missing() const { return points - std::ssize(rows); }
};

/// Where a point was made twice, a row that another machine must come to goes before one that is of its
/// machine, else the one of the file whose name comes first.
SweepResults sweep_results(const SweepFolder& folder, const std::vector<ShardFile>& files);

/// Those of the shards from after + 1 to after + most that lack points, counted from `after` on, as --array
/// takes them: "3,7-9"; empty: none does.
std::string missing_shards(const SweepResults& results, std::int64_t count, std::int64_t after = 0,
                           std::int64_t most = std::numeric_limits<std::int64_t>::max());

/// point, a column for each path and one for each output, status, cause, steps, wall_s, host
CsvTable sweep_table(const SweepPlan& plan, const SweepResults& results);

}  // namespace cloth
