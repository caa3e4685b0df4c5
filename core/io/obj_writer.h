// Triangle meshes as Wavefront OBJ files.
#pragma once

#include <string>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// Vertices and triangles, numbers that read back to the same bits; `title` becomes a comment.
std::string obj_text(const TriangleMesh& mesh, const std::string& title);

}  // namespace cloth
