// The connections of a triangle surface as contact needs them: edges once each, what lies beside them, and
// which triangle answers for a feature that several share.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// Of each triangle, bits 0 to 2: it answers for its vertex k; bits 3 to 5: for its edge from vertex k to k
/// + 1. Every vertex and every edge has exactly one such triangle ("representative triangles", Curtis,
/// Tamstorf and Manocha, "Fast Collision Detection for Deformable Models using Representative-Triangles",
/// 2008).
using RepresentedFeatures = std::uint8_t;

struct Surface {
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> edges;  ///< vertices
  std::vector<std::array<int, 2>>
      beside_edge;                           ///< the third vertices of an edge's first two triangles, or -1
  std::vector<std::array<int, 3>> edges_of;  ///< of each triangle: from vertex k to k + 1
  std::vector<RepresentedFeatures> represented;  ///< of each triangle
  std::vector<int> first_neighbour;              ///< of each vertex in `neighbours`, and one more
  std::vector<int> neighbours;                   ///< vertices that share an edge with it
  std::vector<int> triangle_of_vertex;           ///< the one that answers for it, -1 where there is none
  std::vector<int> triangle_of_edge;

  bool represents_vertex(int triangle, int k) const {
    return represented[static_cast<std::size_t>(triangle)] >> k & 1;
  }
  bool represents_edge(int triangle, int k) const {
    return represented[static_cast<std::size_t>(triangle)] >> (3 + k) & 1;
  }
};

Surface make_surface(int vertices, std::vector<Triangle> triangles);

}  // namespace cloth
