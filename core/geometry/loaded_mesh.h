// A triangle mesh that came from a file, with derived data that does not depend on its placement.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// A mesh as it came from its file, each vertex once.
struct LoadedMesh {
  std::string file;  ///< as requested
  bool built_in = false;
  TriangleMesh surface;                   ///< m
  std::vector<std::array<int, 2>> edges;  ///< each once, lower vertex first, ascending
  /// The vertices opposite an edge of two triangles, each pair once, ascending.
  std::vector<std::array<int, 2>> hinges;
  Eigen::AlignedBox3d bounds;        ///< m, of the vertices
  std::string hash;                  ///< of vertices and triangles, 16 hexadecimal digits
  std::size_t open_edges = 0;        ///< boundary edges, of one triangle only
  std::vector<std::string> notices;  ///< other warnings, one sentence each
};

/// A mesh that was chosen: a file, and its contents when it was read. Two are equal if file and contents are.
struct MeshChoice {
  std::string file;                          ///< relative to the scene's folder, or a built-in mesh; "": none
  std::shared_ptr<const LoadedMesh> loaded;  ///< of `file`, once it has been read (scene/scene_mesh.h)

  bool is_loaded() const { return loaded && loaded->file == file; }
  bool operator==(const MeshChoice& other) const {
    if (file != other.file || is_loaded() != other.is_loaded()) return false;
    return !is_loaded() || loaded == other.loaded || loaded->hash == other.loaded->hash;
  }
};

}  // namespace cloth
