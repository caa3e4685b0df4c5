// What it takes to draw a triangle mesh: normals that keep its edges sharp, and coordinates for a pattern.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// A unit normal for each corner of each triangle: the vertex's, the sum over its triangles by area, but the
/// triangle's own where that is more than 40 degrees off, so that edges stay sharp.
std::vector<Vec3> corner_normals(const TriangleMesh& mesh);

/// Every vertex of a sheet laid flat: its place in m along two directions of the plane in which the triangles
/// lie best, from the lowest of each. A closed surface is seen along its shortest extent.
struct FlatPattern {
  std::vector<Eigen::Vector2d> at;
  Eigen::Vector2d size{0, 0};  ///< m
};
FlatPattern flat_pattern(const TriangleMesh& mesh);

}  // namespace cloth
