// What a triangle mesh is made of: its edges, who faces whom across them, and what is unusual about it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// Two vertices, the lower number first.
using VertexPair = std::array<int, 2>;

struct MeshTopology {
  std::vector<VertexPair> edges;  ///< each once, ascending
  std::vector<VertexPair>
      hinges;  ///< the vertices opposite an edge that triangles share, each pair once, ascending
  std::size_t open_edges = 0;        ///< of one triangle only
  std::vector<std::string> notices;  ///< edges of three triangles and more, winding, a sentence each
};
MeshTopology topology_of(const TriangleMesh& mesh);

/// The mesh that is left when vertices at the same place are one (the first in the file), and triangles
/// without area and vertices without triangles are taken out; and what was done, a sentence each.
struct CleanMesh {
  TriangleMesh mesh;
  std::vector<std::string> notices;
};
CleanMesh cleaned(const TriangleMesh& mesh);

}  // namespace cloth
