// Connectivity of a triangle surface for contact: unique edges, their adjacent vertices, and the
// representative triangle of every vertex and edge.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// Bit mask of a triangle. Bits 0 to 2: it represents its vertex k; bits 3 to 5: its edge from vertex k to k
/// + 1. Every vertex and every edge has exactly one representative triangle (Curtis et al. 2008), so that
/// each pair of features is found once.
using RepresentedFeatures = std::uint8_t;

struct Surface {
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> edges;  ///< vertices
  std::vector<std::array<int, 2>>
      beside_edge;                           ///< the third vertices of an edge's first two triangles, or -1
  std::vector<std::array<int, 3>> edges_of;  ///< of each triangle: from vertex k to k + 1
  std::vector<RepresentedFeatures> represented;  ///< of each triangle
  std::vector<int> first_neighbour;              ///< of each vertex, its offset in `neighbours`; and the end
  std::vector<int> neighbours;                   ///< vertices that share an edge with it
  std::vector<int> triangle_of_vertex;           ///< its representative, -1 where there is none
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
