// Triangle meshes from Wavefront OBJ files: vertices and faces; materials, normals, textures and groups are
// passed over.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// A mesh, or why there is none: "bunny.obj:12: ...". Exactly one of the two is there.
struct ObjReading {
  std::optional<TriangleMesh> mesh;
  std::string problem;
};

/// Vertices in the file's order and to its last digit, whatever the locale; faces of more than three corners
/// cut into triangles. `place` names the text in problems.
ObjReading parse_obj(const std::string& text, const std::string& place);

/// The same from a file, which problems call by its name alone.
ObjReading read_obj(const std::filesystem::path& path);

}  // namespace cloth
