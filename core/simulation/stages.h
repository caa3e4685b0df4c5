// Which stages a scene is run with, and which were left out and why.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "scene/stage_info.h"

namespace cloth {

/// Every stage that a step can have, in the order in which a step runs them.
std::vector<StageInfo> explain_stages(const Scene& scene);

}  // namespace cloth
