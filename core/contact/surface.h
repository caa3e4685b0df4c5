// Connectivity of a triangle surface for contact: unique edges, their adjacent vertices, and the
// representative triangle of every vertex and edge.
#pragma once

#include <array>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

struct Surface {
  std::vector<Triangle> triangles;
  std::vector<std::array<int, 2>> edges;  ///< vertices
  std::vector<std::array<int, 2>>
      beside_edge;                           ///< the third vertices of an edge's first two triangles, or -1
  std::vector<std::array<int, 3>> edges_of;  ///< of each triangle: from vertex k to k + 1
  std::vector<int> first_neighbour;          ///< of each vertex, its offset in `neighbours`; and the end
  std::vector<int> neighbours;               ///< vertices that share an edge with it
  /// Of each vertex and edge one triangle, which represents it where closest points are those of several
  /// pairs (Curtis et al. 2008); -1 where there is none.
  std::vector<int> triangle_of_vertex, triangle_of_edge;
};

Surface make_surface(int vertices, std::vector<Triangle> triangles);

}  // namespace cloth
