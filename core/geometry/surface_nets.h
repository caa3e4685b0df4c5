// Triangulation of a surface that is given by a distance function.
#pragma once

#include <Eigen/Geometry>
#include <functional>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// Approximate signed distance to a body's surface in m, negative inside. Its gradient must not exceed
/// about 1.
using DistanceFunction = std::function<double(const Vec3&)>;

/// Surface nets (Gibson 1998): one vertex in each cube of side `cell` that the surface passes, moved onto it
/// as far as the cube allows, and two triangles for each edge of the lattice that it cuts, split along the
/// shorter diagonal. Closed and facing outward if the body lies within `bounds` and is thick and smooth
/// against a cell. Cubes that are farther from the surface than the distance says are passed over eight at a
/// time along each axis.
TriangleMesh surface_nets(const DistanceFunction& distance, const Eigen::AlignedBox3d& bounds, double cell);

}  // namespace cloth
