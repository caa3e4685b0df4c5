// The motion of an obstacle as the scene describes it: constant velocity and spin, or keyframes.
#pragma once

#include "geometry/rigid_motion.h"
#include "scene/scene.h"

namespace cloth {

/// m, the centre of an obstacle's rotation before any motion: centre of a sphere or box, point of a plane,
/// origin of a mesh.
Vec3 pivot_of(const Obstacle& obstacle);

bool moves(const Obstacle& obstacle);

/// The pose at `time` (s).
Pose pose_of(const Obstacle& obstacle, double time);

/// m/s, upper bound over all times of the speed of any point within `reach` metres of the pivot.
double highest_speed(const Obstacle& obstacle, double reach);

}  // namespace cloth
