// Triangle meshes with shared vertices: obstacles from files, cloths of any shape.
#pragma once

#include <array>
#include <vector>

#include "geometry/at.h"
#include "geometry/vec3_field.h"

namespace cloth {

/// Indices into the vertices, anticlockwise as seen from the front.
using Triangle = std::array<int, 3>;

struct TriangleMesh {
  std::vector<Vec3> vertices;  ///< m
  std::vector<Triangle> triangles;

  /// m^2: twice the area of a triangle, along its normal.
  Vec3 area_normal(const Triangle& t) const {
    const Vec3& first = vertices[at(t[0])];
    return (vertices[at(t[1])] - first).cross(vertices[at(t[2])] - first);
  }
};

}  // namespace cloth
