// Which stages a scene is run with, and which were left out and why.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace cloth {

struct StageInfo {
  std::string name;
  bool present = false;
  std::string reason;  ///< what it does here, or why it is not needed
};

/// Every stage that a step can have, in the order in which a step runs them.
std::vector<StageInfo> explain_stages(const Scene& scene);

}  // namespace cloth
