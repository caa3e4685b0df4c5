// Triangulation of polygons.
#pragma once

#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// `corners` (at least three) are vertices in their order around a polygon, in a plane or nearly so. As many
/// triangles as it has corners, less two, turning as it does; the time hardly grows faster than the number of
/// corners. Of a polygon that crosses itself they are some triangles between its corners; empty where that
/// would take too long.
std::vector<Triangle> cut_polygon(const std::vector<Vec3>& vertices, std::span<const int> corners);

}  // namespace cloth
