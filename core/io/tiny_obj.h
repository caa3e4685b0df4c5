// The one place that knows tinyobjloader.
#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// The faces of an OBJ text of lines "f 1 2 3 4", corners numbered from 1, as triangles: of four corners
/// along the shorter diagonal, of more by cutting off ears. Precondition: every corner is there.
std::vector<Triangle> cut_into_triangles(const std::vector<Vec3>& vertices, const std::string& faces);

}  // namespace cloth
