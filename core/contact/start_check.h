// Whether a scene starts outside of its obstacles and free of crossings, and an edit leaves it so: what
// contact keeps it must find.
#pragma once

#include <optional>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "scene/obstacle_motion.h"
#include "scene/scene_json.h"

namespace cloth {

/// A problem for each obstacle that the cloth touches at t = 0, with the first place found, and one where the
/// cloth passes through itself or touches itself although self_contact forbids it. Where contact is not
/// continuous, one for each obstacle that a free particle starts in; it may touch.
/// Precondition: the scene has no other problems.
std::vector<Problem> find_start_problems(const Scene& scene);

/// A scene that can be run from its start: read_scene, with the start's problems where there are no others.
SceneReading read_runnable_scene(const std::string& text, const std::string& place,
                                 const std::vector<Override>& overrides = {}, const MeshSource& meshes = {});

/// Whether a cloth touches an obstacle in a pose, or is in it where that is solid (a mesh is not).
bool touches(const TriangleMesh& cloth, const Obstacle& obstacle, const Pose& pose);

/// Where a cloth has points in common with itself. Signs are exact: a flat cloth has none, however it lies.
struct SelfIntersection {
  bool passes = false;  ///< through itself; else it only touches itself
  int particle = 0;     ///< of a face that does
};
std::optional<SelfIntersection> find_self_intersection(const TriangleMesh& cloth);

}  // namespace cloth
