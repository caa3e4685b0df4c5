// Data for drawing a triangle mesh: normals that keep its edges sharp, and texture coordinates.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// A unit normal for each corner of each triangle: the vertex normal, weighted by area, or the triangle's own
/// normal where the two differ by more than 40 degrees, so that edges stay sharp.
std::vector<Vec3> corner_normals(const TriangleMesh& mesh);

/// Coordinates of every vertex, in m, in the plane that fits the triangles best, with the minimum of
/// each coordinate as origin. A closed surface is projected along its shortest extent.
struct FlatPattern {
  std::vector<Eigen::Vector2d> at;
  Eigen::Vector2d size{0, 0};  ///< m
};
FlatPattern flat_pattern(const TriangleMesh& mesh);

}  // namespace cloth
