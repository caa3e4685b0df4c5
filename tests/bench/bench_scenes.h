// What is measured: one hanging cloth, and the same with one stage more.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace cloth::bench {

/// `size` x `size` particles pinned at two corners: springs, gravity, viscous damping, `auto` time step.
Scene hanging_cloth(int size, const std::string& method);

struct ExtraStage {
  std::string name;
  void (*add)(Scene&);
};
const std::vector<ExtraStage>& extra_stages();

}  // namespace cloth::bench
