// The rows of a sweep as its shard files have them. A shard file belongs to one attempt, that is to one
// process on one machine: it alone writes it, at the end only. Lines are JSON; the first one says who writes.
//
//     {"format":"clothlab/sweep-rows/1","plan":"9f...","version":"0.3.0","instruction_set":"avx2",
//      "processor":"...","host":"node7","shard":17,"shards":400}
//     {"point":16,"scene":"0a...","status":"finished","outputs":[0.12,null],"steps":200,"wall_s":0.031}
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/shard.h"

namespace cloth {

/// `refused`: the scene of the point breaks a rule, or has no stable step. `unsolvable`: the equations of a
/// step, or contact, could not be solved. Of the machine, not of the point, are the last two alone.
enum class PointStatus { finished, diverged, unsolvable, refused, limit_steps, limit_wall, no_memory };
inline constexpr int point_statuses = 7;
const char* name_of(PointStatus status);

/// Whether another machine must come to the same.
inline bool is_reproducible(PointStatus status) {
  return status != PointStatus::limit_wall && status != PointStatus::no_memory;
}

struct PointRow {
  std::int64_t point = 0;
  std::string scene{};  ///< hash of its resolved scene: the point's identity
  PointStatus status = PointStatus::finished;
  std::string cause{};            ///< of all but a plain finish; of a finish what it should be read with
  std::vector<double> outputs{};  ///< not a number: there is none
  std::int64_t steps = 0;
  double wall = 0;  ///< s
};

/// Equal in every bit but the wall time, or of the machine.
bool agree(const PointRow& a, const PointRow& b);

/// Whether a point can be of both.
bool may_share_points(const Shard& a, const Shard& b);

struct Attempt {
  std::string plan{};  ///< hash
  std::string version{}, instruction_set{}, processor{}, host{};
  Shard shard{};

  /// "node7 (AMD EPYC 9654, avx512)"
  std::string maker() const;
};

std::string line_of(const Attempt& attempt);
std::string line_of(const PointRow& row);

/// A shard file as far as it can be read. A last line that was not written to its end is left out, as is
/// whatever a loss of power left that is no row: those points are made again.
struct ShardFile {
  std::string name{};
  Attempt attempt{};
  std::vector<PointRow> rows{};
  std::int64_t damaged = 0;  ///< lines that are no rows; of a file without a first line all
};
ShardFile parse_shard_file(const std::string& name, const std::string& text, std::size_t outputs);

/// "17-of-400.node7.1234.jsonl", and the shard back.
std::string shard_file_name(const Shard& shard, const std::string& host, std::int64_t process, int attempt);
std::optional<Shard> shard_of_file(const std::string& name);

}  // namespace cloth
