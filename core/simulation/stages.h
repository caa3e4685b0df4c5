// Lists the stages of a step for a scene, with those that are left out and why: what `clothlab-cli explain`
// prints. Forces come first, then the integrator with its force evaluations per step, limiter and contact.
// The cost of contact depends on its kind; see contact/contact_stage.h. `clothlab-bench` measures a step
// of each kind, with a sphere too (docs/performance.md).
#pragma once

#include <vector>

#include "scene/blocks.h"

namespace cloth {

/// Every stage that a step can have, in the order in which a step runs them.
std::vector<StageInfo> explain_stages(const Scene& scene);

}  // namespace cloth
