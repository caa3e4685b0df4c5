// Triangles that share their vertices: obstacles from files, cloths of any shape.
#pragma once

#include <array>
#include <vector>

#include "geometry/vec3_field.h"

namespace cloth {

/// Indices into the vertices, anticlockwise as seen from the front.
using Triangle = std::array<int, 3>;

struct TriangleMesh {
  std::vector<Vec3> vertices;  ///< m
  std::vector<Triangle> triangles;
};

}  // namespace cloth
