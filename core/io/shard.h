// Which part of a whole this process makes, said on the command line or by the scheduler that started it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>

#include "params/problem.h"

namespace cloth {

/// Part I of N, I from 1: what has a number p with p mod N = I - 1.
struct Shard {
  std::int64_t index = 1, count = 1;
  bool has(std::int64_t number) const { return number % count == index - 1; }
  bool operator==(const Shard&) const = default;
};

/// The value of an environment variable; empty where it is not set.
using Environment = std::function<std::string(const char* name)>;

/// "17/400"; "auto/400": the index that the scheduler gives; "auto": index and number from the scheduler.
/// With "auto+1000/2500" 1000 is added to the index. Slurm, PBS, SGE, LSF and GNU parallel are asked, in this
/// order; the number is known of Slurm's, SGE's and LSF's arrays without gaps that begin at 0 or 1.
std::variant<Shard, Problem> shard_from(const std::string& text, const Environment& environment);

}  // namespace cloth
