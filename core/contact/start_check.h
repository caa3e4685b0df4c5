// Checks that the cloth starts outside of all obstacles and does not intersect itself. Contact preserves this
// condition, but cannot establish it.
#pragma once

#include <optional>
#include <vector>

#include "geometry/rigid_motion.h"
#include "geometry/triangle_mesh.h"
#include "scene/scene_json.h"

namespace cloth {

/// With continuous contact: a problem for each obstacle that the cloth touches at t = 0, with the first
/// position found, and one if the cloth intersects or touches itself and the scene has self_contact. Without:
/// a problem for each obstacle that contains a free particle; particles on its surface are allowed.
/// Precondition: the scene has no other problems.
std::vector<Problem> find_start_problems(const Scene& scene);

/// read_scene(), which also reports the start's problems if the text has no others.
SceneReading read_runnable_scene(const std::string& text, const std::string& place,
                                 const std::vector<Override>& overrides = {}, const MeshSource& meshes = {});

/// Whether a cloth touches an obstacle in a pose or lies inside it. A mesh is a surface without an inside.
bool touches(const TriangleMesh& cloth, const Obstacle& obstacle, const Pose& pose);

/// A self-intersection of a cloth, found with exact predicates: a flat cloth has none in any position.
struct SelfIntersection {
  bool passes = false;  ///< a face passes through another; false: it only touches it
  int particle = 0;     ///< of such a face
};
std::optional<SelfIntersection> find_self_intersection(const TriangleMesh& cloth);

}  // namespace cloth
