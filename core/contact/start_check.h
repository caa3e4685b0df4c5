// Whether a scene starts free of crossings, and an edit leaves it so: what continuous contact keeps it must
// find.
#pragma once

#include <vector>

#include "contact/rigid_motion.h"

namespace cloth {

/// A problem for each obstacle that the cloth touches at t = 0, with the first place found, and one where the
/// cloth passes through itself although self_contact forbids it. Nothing where contact is not continuous.
/// Precondition: the scene has no other problems.
std::vector<Problem> find_start_problems(const Scene& scene);

/// Whether a cloth touches an obstacle in a pose, or is in it where that is solid (a mesh is not).
bool touches(const TriangleMesh& cloth, const Obstacle& obstacle, const Pose& pose);
bool passes_through_itself(const TriangleMesh& cloth);

}  // namespace cloth
