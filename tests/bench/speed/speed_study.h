// What Clothlab costs on this machine: the time of a step by method, size, threads and feature beside a plain
// kernel and the machine's own limits, its growth with size, what contact adds, the speed of the built-in
// scenes, memory and start.
//
// Absolute times are this machine's and this minute's; the ratios are what carries over.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/speed/contact_costs.h"
#include "bench/speed/growth.h"
#include "bench/speed/process_costs.h"
#include "bench/speed/scene_speeds.h"
#include "bench/speed/step_costs.h"
#include "io/machine.h"

namespace cloth::speed {

/// "steps", "contact", "scenes", "memory", "start"
const std::vector<std::string>& speed_parts();

struct SpeedOptions {
  std::vector<std::string> parts;  ///< of speed_parts(); empty: all
  /// Empty: 32 to 512, but to 128 with methods that solve equations; scenes as they are. Else scenes are
  /// refined to these.
  std::vector<int> sizes;
  std::vector<std::string> scenes;    ///< of builtin_scenes(); empty: all
  double scene_seconds = 1;           ///< of stepping each scene at each size
  std::vector<std::string> methods;   ///< of integrator_names(); empty: all
  std::vector<std::string> features;  ///< names of features() beside the bare cloth; empty: all
  std::vector<int> threads;           ///< empty: one, and as many as the machine has
  int repeats = 15;
  bool quick = false;             ///< small sizes and short timings: seconds instead of minutes
  std::filesystem::path program;  ///< clothlab-cli, whose start is timed; empty: that row is left out
  /// Asked all the time; false ends the study, and what is finished is kept.
  std::function<bool(double fraction, const std::string& text)> progress;
};

struct SpeedReport {
  MachineFacts machine;
  bool complete = false;
  int repeats = 0;
  Yardsticks yardsticks;
  std::vector<StepCost> rows;  ///< by size
  double disagreement = 0;     ///< m, the largest of all sizes, see SizeCosts
  std::vector<Growth> growth;
  std::vector<ContactCost> contact;
  std::vector<SceneSpeed> scenes;  ///< by size
  std::vector<SceneGrowth> scene_growth;
  std::vector<MemoryCost> memory;
  std::vector<StartCost> starts;

  bool reference_agrees() const { return disagreement <= largest_disagreement; }
};

/// The rows that are wanted at one size: every method bare, and with each feature where methods were named,
/// else semi-implicit Euler and Verlet with each feature. More than one thread: only explicit methods.
std::vector<Wanted> wanted_rows(const SpeedOptions& options, int size);

/// Precondition: names in the options exist, sizes are from 4 to 2048, numbers of threads are at least 1.
SpeedReport study_speed(const SpeedOptions& options);

}  // namespace cloth::speed
