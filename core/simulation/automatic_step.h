// The time step "auto" during a run. Below the stability limit for every shape no energy grows exponentially,
// but with Verlet and semi-implicit Euler the energy of a violent scene may still grow slowly: by resonances,
// and by springs that pass through zero length. So the energy ledger is checked every few steps; where it
// shows unexplained energy the step is divided by sqrt(2), at most four times, and never becomes longer
// again.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "simulation/outcome.h"

namespace cloth {

/// The state of the automatic step; part of RunState.
struct AutomaticStep {
  double longest = 0;      ///< s, resolved_time_step() of the scene
  double origin = 0;       ///< s, the time from which record intervals are counted
  double least_error = 0;  ///< the lowest energy error since the last change, in energy scales
  int shortened = 0;       ///< times
  std::int64_t next_change =
      -1;  ///< the step that ends a record interval, after which `next_time_step` is in force; -1: none
  double next_time_step = 0;  ///< s
  std::vector<StepChange> changes;
};

/// Steps between two looks at the ledger, for the choice of the step as for divergence.
inline constexpr std::int64_t ledger_interval = 8;

/// Whether the step of this scene is checked: it is "auto", the method may gain energy below its limit
/// (MethodFacts::may_heat), and there are springs.
bool is_step_watched(const Scene& scene);

/// Whether an energy error, in units of Simulation::energy_scale(), requires a shorter step. Records the
/// lowest error.
bool asks_for_shorter(AutomaticStep& automatic, double error);

/// The number of steps of a record interval after so many shortenings: the smallest that is short enough.
std::int64_t steps_after_shortening(double interval, double longest, int shortened);

}  // namespace cloth
