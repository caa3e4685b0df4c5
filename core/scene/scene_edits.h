// What changed between two scenes, parameter by parameter, for logs; and such changes put in again.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_json.h"

namespace cloth {

struct SceneEdit {
  std::string path;   ///< of a parameter, a block that came or went, or "cloth.pins"
  std::string value;  ///< JSON: the new value; "null" for a block that went
};

/// The edits that lead from `before` to `after`.
std::vector<SceneEdit> edits_between(const Scene& before, const Scene& after);

/// The way back: `scene` with all of `edits`, checked as a file is. Edits found between two scenes that can
/// be run lead from the one to what write_scene writes of the other. Problems have the scene's paths.
SceneReading edited_scene(const Scene& scene, const std::vector<SceneEdit>& edits);

}  // namespace cloth
