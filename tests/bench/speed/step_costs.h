// ns per particle and step of every method and feature at one size, beside the reference kernel.
#pragma once

#include <string>
#include <vector>

#include "bench/speed/interleaved_timing.h"
#include "bench/speed/speed_scenes.h"
#include "bench/speed/yardsticks.h"

namespace cloth::speed {

inline constexpr const char* reference_method = "reference";

struct StepCost {
  int size = 0;                            ///< particles along an edge
  std::string method;                      ///< of integrator_names(), or reference_method
  std::string feature;                     ///< of features()
  int threads = 1;                         ///< that the engine used
  double time_step = 0;                    ///< s
  int samples = 0;                         ///< 0: not timed, `remark` says why
  Spread time = {};                        ///< ns per particle and step
  Spread to_reference = {}, to_bare = {};  ///< ratios, sample by sample
  double to_divider = 0, to_memory = 0;    ///< ratios to divider_floor and memory_floor
  double evaluations = 0;                  ///< of the force, per step
  double inner_steps = 1;                  ///< per step, those that were rejected included
  double sweeps = 0, velocity_iterations = 0, linear_iterations = 0;  ///< per step
  std::string remark = {};

  double seconds_per_step() const { return 1e-9 * time.median * size * size; }
};

/// One row that is wanted.
struct Wanted {
  std::string method, feature;
  int threads = 1;
  bool operator==(const Wanted&) const = default;
};

struct SizeCosts {
  std::vector<StepCost> rows;  ///< the reference kernel first
  double disagreement = 0;     ///< m between reference kernel and semi-implicit Euler after the same steps
  bool complete = false;       ///< false: it was ended, and there are no rows
};

/// Above this the reference kernel and the engine do not compute the same motion.
inline constexpr double largest_disagreement = 1e-9;  // m

struct StepPlan {
  TimingPlan timing;
  Yardsticks yardsticks;
  double longest_step = 3;  ///< s: a row that would need more for a step is left out, with a remark
};

/// Rows in the order of `wanted`, those left out last. `smaller` are rows of smaller sizes, by which it is
/// judged what would take too long.
SizeCosts measure_size(int size, const std::vector<Wanted>& wanted, const StepPlan& plan,
                       DevelopedCloths& cloths, const std::vector<StepCost>& smaller,
                       const TimingProgress& progress = {});

/// Asks the engine for so many threads; how many it will use.
int use_threads(Simulation& simulation, int threads);

}  // namespace cloth::speed
