// What this machine can do at best, measured: square roots and divisions, and memory, on one core. A step of
// a mass-spring cloth needs both, so that each sets a floor under its time. And what its cores gain together
// when they have nothing to do with each other: no threads of one step can gain more.
#pragma once

#include <cstddef>
#include <string>

#include "bench/speed/interleaved_timing.h"

namespace cloth::speed {

struct Yardsticks {
  Spread scalar_root;           ///< ns for 1 / sqrt(x), exact, one double at a time
  Spread vector_root;           ///< ns for the same per double, in the widest vectors of the machine
  std::string vectors;          ///< "AVX-512", "AVX2", "baseline"
  Spread triad;                 ///< ns per element of a = b + s c, 24 bytes counted (McCalpin 1995)
  Spread update;                ///< ns per element of x += s v in place, 24 bytes moved
  std::size_t array_bytes = 0;  ///< of each array of the last two
  int cores = 1;
  Spread together;  ///< times the roots that one core takes, if each takes its own at once; 1 with one core

  /// GB/s, one core.
  double triad_throughput() const { return bytes_per_element / triad.median; }
  double update_throughput() const { return bytes_per_element / update.median; }

  static constexpr double bytes_per_element = 24;
};

struct YardstickPlan {
  TimingPlan timing;
  std::size_t array_bytes = 0;  ///< 0: four times the largest cache, 64 MiB at least
};

/// Ended by `progress`: what was not measured is 0.
Yardsticks measure_yardsticks(const YardstickPlan& plan, const TimingProgress& progress = {});

/// Least ns that a step can take per particle if it divides and takes roots exactly, one of each per spring
/// and force evaluation, on one core.
double divider_floor(const Yardsticks& yardsticks, double springs_per_particle, double evaluations);

/// Least ns that a step can take per particle if positions and velocities come from memory and go back there
/// once, 96 bytes, on one core. A cloth that fits into the caches may be faster.
double memory_floor(const Yardsticks& yardsticks);

}  // namespace cloth::speed
