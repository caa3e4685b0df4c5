// What the deformation rate costs, and what excess it leaves for that: rates, solvers and numbers of sweeps
// on a cloth hung by two corners, each from the same state of a cloth that has long been kept to the rate.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/speed/interleaved_timing.h"

namespace cloth::speed {

struct LimiterChoice {
  std::string solver;
  std::int64_t max_sweeps = 0;
};

struct LimiterOptions {
  std::vector<double> rates{0.1, 0.01, 0.001};
  std::vector<LimiterChoice> choices{{"sweeps", 10}, {"sweeps", 50},   {"sweeps", 200},
                                     {"auto", 200},  {"sweeps", 2000}, {"direct", 200}};
  double developed_time = 0.4;  ///< s of hanging before anything is timed
  int repeats = 7;              ///< of each timing; 3 of the direct solver's
  double moment = 0.05;         ///< s that one timing takes, about
};

struct LimiterRow {
  double rate = 0;     ///< 0: no limiter, what the others are compared with
  std::string solver;  ///< empty: a rate that nothing exceeds, so that only looking is paid for
  std::int64_t max_sweeps = 0;
  double least = 0;    ///< ns per particle and step, the whole step, in the quickest repeat
  Spread time;         ///< the same in all repeats
  double to_bare = 0;  ///< ratio of the quickest repeat to that of the step without a limiter
  double sweeps = 0, iterations = 0;           ///< per step
  double mean_excess = 0, largest_excess = 0;  ///< left after a step
};

/// Semi-implicit Euler, `size` x `size` particles. Throws std::runtime_error if a run diverges.
std::vector<LimiterRow> measure_limiter(int size, const LimiterOptions& options);

/// With a heading line, as `clothlab-limiter-bench` prints it.
std::string limiter_table(int size, const std::vector<LimiterRow>& rows);

}  // namespace cloth::speed
