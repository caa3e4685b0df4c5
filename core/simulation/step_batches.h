// Takes steps in batches (Simulation::advance). The size of a batch follows from measured time, so that
// requests which are handled between two batches wait for some milliseconds at most.
#pragma once

#include <functional>
#include <optional>

#include "simulation/simulation.h"

namespace cloth {

/// How many steps the next batch has: about 2 ms of them, 32 at most.
class BatchSize {
 public:
  std::int64_t steps() const { return steps_; }
  void note(std::int64_t steps, double seconds);  ///< records the time that a batch took

 private:
  std::int64_t steps_ = 1;
};

/// Runs a simulation whose states are read only occasionally; bitwise the same as single steps. The
/// simulation must outlive it.
class StepBatches {
 public:
  /// `stop` is called after every batch; when it returns true the run ends. May be empty.
  StepBatches(Simulation& simulation, std::function<bool()> stop)
      : simulation_(simulation), stop_(std::move(stop)) {}

  /// Runs until step `last`. Returns false where the simulation diverged (its state is the diverged one) or
  /// was stopped.
  bool run_to(std::int64_t last);

  const std::optional<Divergence>& divergence() const { return divergence_; }
  double seconds() const { return seconds_; }  ///< wall time spent in steps only

 private:
  Simulation& simulation_;
  std::function<bool()> stop_;
  BatchSize size_;
  std::optional<Divergence> divergence_;
  double seconds_ = 0;
};

/// Hardware threads of this machine; at least 1.
int machine_threads();

/// Steps of the present length until the time has passed `end` (s), but only those up to where that length
/// changes: at the end of the record interval within which "auto" has shortened it. At least 1.
std::int64_t steps_beyond(const Simulation& simulation, double end);

}  // namespace cloth
