// Boxes around what moves: the path of an obstacle's point, and the cloth in an obstacle's coordinates.
#pragma once

#include <vector>

#include "contact/obstacle_body.h"
#include "contact/regions.h"

namespace cloth {

/// m, largest distance of an arc from its chord, for a point at rest, `radius` metres from an obstacle's
/// pivot at the start of its path, in the obstacle's coordinates.
double seen_bulge(const PoseInterpolation& path, double radius);

/// Around the path of a point of an obstacle, grown by `reach`.
Bounds swept_box(const PoseInterpolation& path, const Vec3& pivot, const Vec3& point, double reach);

/// Boxes of the cloth in the coordinates of an obstacle, for its whole path, grown by `reach`.
void seen_from_body(const ObstacleBody& body, const PoseInterpolation& path, const std::vector<Bounds>& boxes,
                    double reach, std::vector<Bounds>& seen);

/// A particle in the coordinates of an obstacle at rest, grown by `reach`.
Capsule seen_at_rest(const PoseInterpolation& path, const Capsule& capsule, double reach);

}  // namespace cloth
