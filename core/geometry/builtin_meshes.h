// Meshes that the program generates and that scenes refer to like files.
#pragma once

#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

struct BuiltinMesh {
  std::string name;  ///< "bunny.obj"
  std::string title;
  TriangleMesh (*make)();
};

const std::vector<BuiltinMesh>& builtin_meshes();

/// nullptr if there is none of that name.
const BuiltinMesh* find_builtin_mesh(const std::string& name);

}  // namespace cloth
