// Steps taken in batches (Simulation::advance): of a frame, of a row, of all between two of them. Their
// number follows the clock, so that whoever has to be asked between two batches waits for a moment at most.
#pragma once

#include <functional>
#include <optional>

#include "simulation/simulation.h"

namespace cloth {

/// How many steps the next batch has: about 2 ms of them, 32 at most.
class BatchSize {
 public:
  std::int64_t steps() const { return steps_; }
  void note(std::int64_t steps, double seconds);  ///< that a batch of so many steps took

 private:
  std::int64_t steps_ = 1;
};

/// A run whose states are looked at only now and then, to the bit the same as by single steps. The simulation
/// must outlive it.
class StepBatches {
 public:
  /// `stop` is asked after every batch; true ends it. Empty: nothing does.
  StepBatches(Simulation& simulation, std::function<bool()> stop)
      : simulation_(simulation), stop_(std::move(stop)) {}

  /// Until the simulation is at step `last`. False: it diverged, and its state is the bad one; or it was
  /// stopped.
  bool run_to(std::int64_t last);

  const std::optional<Divergence>& divergence() const { return divergence_; }
  double seconds() const { return seconds_; }  ///< of wall time, of stepping alone

 private:
  Simulation& simulation_;
  std::function<bool()> stop_;
  BatchSize size_;
  std::optional<Divergence> divergence_;
  double seconds_ = 0;
};

/// Threads that may work at once on this machine; at least 1.
int machine_threads();

/// Steps of `time_step` (s) until `time` has passed `end`; at least 1.
std::int64_t steps_beyond(double time, double end, double time_step);

}  // namespace cloth
