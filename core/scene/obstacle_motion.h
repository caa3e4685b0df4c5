// Where an obstacle is by its own motion, a function of time alone.
#pragma once

#include "geometry/rigid_motion.h"
#include "scene/scene.h"

namespace cloth {

/// The point about which an obstacle spins: centre of a sphere or box, point of a plane, origin of a placed
/// mesh. In m, before any motion.
Vec3 pivot_of(const Obstacle& obstacle);

bool moves(const Obstacle& obstacle);

/// `time` in s.
Pose pose_of(const Obstacle& obstacle, double time);

/// m/s, at most, of any point within `reach` metres of the pivot, at any time.
double highest_speed(const Obstacle& obstacle, double reach);

}  // namespace cloth
