// What "auto" does while a run goes on. Below the limit of every shape no energy grows exponentially, but
// Verlet and semi-implicit Euler may still heat a violent scene slowly: resonances, springs that pass through
// zero length. So the ledger of energy is looked at every few steps, and where energy that nothing explains
// has come in, the step becomes shorter by sqrt(2): at most four times, never longer again.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "simulation/outcome.h"

namespace cloth {

/// How the step of a run stands; a part of its state.
struct AutomaticStep {
  double longest = 0;      ///< s, what the scene alone says
  double origin = 0;       ///< s, from where record intervals are counted
  double least_error = 0;  ///< the lowest energy error since the last change, in energy scales
  int shortened = 0;       ///< times
  std::int64_t next_change =
      -1;  ///< the step that ends a record interval, after which `next_time_step` is in force; -1: none
  double next_time_step = 0;  ///< s
  std::vector<StepChange> changes;
};

/// Steps between two looks at the ledger, for the choice of the step as for divergence.
inline constexpr std::int64_t ledger_interval = 8;

/// Whether the step of this scene is watched: "auto", with a method that may heat below its limit, and with
/// springs.
bool is_step_watched(const Scene& scene);

/// Whether an energy error, in energy scales, asks for a shorter step. Keeps the lowest one so far.
bool asks_for_shorter(AutomaticStep& automatic, double error);

/// Steps of a record interval after so many shortenings: the fewest whole ones that are short enough.
std::int64_t steps_after_shortening(double interval, double longest, int shortened);

}  // namespace cloth
