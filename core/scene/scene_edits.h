// What changed between two scenes, parameter by parameter, for logs.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace cloth {

struct SceneEdit {
  std::string path;   ///< of a parameter, a block that came or went, or "cloth.pins"
  std::string value;  ///< JSON: the new value; "null" for a block that went
};

/// The edits that lead from `before` to `after`.
std::vector<SceneEdit> edits_between(const Scene& before, const Scene& after);

}  // namespace cloth
