// The differences between two scenes, parameter by parameter, for the log of edits, and their application to
// a scene.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_json.h"

namespace cloth {

struct SceneEdit {
  std::string path;   ///< of a parameter, of a block that was added or removed, or "cloth.pins"
  std::string value;  ///< JSON: the new value; "null" for a removed block
};

/// The edits that lead from `before` to `after`.
std::vector<SceneEdit> edits_between(const Scene& before, const Scene& after);

/// Applies `edits` to `scene` and checks the result like a scene file. For two valid scenes,
/// edited_scene(before, edits_between(before, after)) is the scene that write_scene(after) describes.
/// Problems name the scene's paths.
SceneReading edited_scene(const Scene& scene, const std::vector<SceneEdit>& edits);

}  // namespace cloth
