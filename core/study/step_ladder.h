// Which steps a study of error against run time takes: the horizon is a whole number of every one of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "integrators/registry.h"
#include "scene/scene.h"

namespace cloth {

/// min(duration, 150 periods of the fastest oscillation), the latter rounded down to one of 1, 1.5, 2, 2.5,
/// 3, 4, 5, 6, 8 times a power of ten. s
double default_horizon(const Scene& scene);

/// How one method's runs follow each other: rung 0 is the coarsest one that should work, each further rung
/// halves the step or takes a tenth of the tolerance; rung -1 lies beyond the stability limit.
struct StepLadder {
  MethodFacts facts;
  std::optional<double> limit;    ///< s; none: no step is stable; infinity: every one is
  bool by_tolerance = false;      ///< error control chooses the steps
  std::int64_t first_steps = 0;   ///< of rung 0
  std::int64_t beyond_steps = 0;  ///< of rung -1; 0: there is none

  std::int64_t steps(int rung) const;  ///< over the horizon
  double tolerance(int rung) const;    ///< 0 where not by_tolerance
};

struct Ladders {
  double horizon = 0;  ///< s
  int samples = 0;     ///< fixed times horizon * k / samples; divides every run's number of steps
  std::vector<StepLadder> methods;
};

/// From just under each method's limit. Methods without one begin at the longer of 1/60 s and twice the limit
/// of Verlet; those that have no stable step, or only one far below 1/omega, at 0.4/omega. `samples` is the
/// most of 50 that costs no method more than a tenth of its coarsest step.
Ladders make_ladders(const Scene& scene, const std::vector<std::string>& methods, double horizon);

/// The scene with this method and rung; settings of the method that the scene has are kept.
Scene scene_at(const Scene& scene, const StepLadder& ladder, int rung, double horizon);

}  // namespace cloth
