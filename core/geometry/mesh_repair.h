// Checks and repairs of meshes from files: merging equal vertices, finding faults, listing edges.
#pragma once

#include <array>
#include <compare>
#include <string>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

struct Weld {
  TriangleMesh mesh;
  std::vector<int> number;      ///< of each input vertex, its index in `mesh`
  int merged_vertices = 0;      ///< how many were removed
  int collapsed_triangles = 0;  ///< removed, because two of their corners were merged
};

/// Merges each vertex into the first earlier one that was kept and is no further than `tolerance` (m, at
/// least 0) away.
Weld weld(const TriangleMesh& mesh, double tolerance);

/// The edge of a triangle from a corner (0 to 2) to the next one.
struct HalfEdge {
  int low, high;  ///< vertices
  int triangle, corner;
  auto operator<=>(const HalfEdge&) const = default;
};
/// All of them, sorted: those of one edge follow one another.
std::vector<HalfEdge> half_edges(const std::vector<Triangle>& triangles);

/// An edge and the triangles that share it, in their order.
struct MeshEdge {
  int from = 0, to = 0;  ///< vertices, from < to
  std::array<int, 2> opposite = {-1,
                                 -1};  ///< the third vertices of the first two triangles; -1: there is none
  int triangles = 0;                   ///< how many share it
  int forward = 0;                     ///< how many of them run from `from` to `to`
};

/// Every edge once, sorted by its vertices. Triangles that repeat a vertex are ignored.
std::vector<MeshEdge> unique_edges(const TriangleMesh& mesh);

enum class MeshFault {
  degenerate_triangle,   ///< repeats a vertex, or has an area of less than 1e-12 of its longest edge squared
  open_edge,             ///< of one triangle only
  inconsistent_winding,  ///< an edge along which its two triangles run the same way
  crowded_edge,          ///< of more than two triangles
  unused_vertex,         ///< of no triangle
};

struct MeshFinding {
  MeshFault fault;
  int count = 0;
  int first = 0;        ///< a triangle, a vertex, or the lower vertex of an edge
  std::string message;  ///< "4 open edges, the first between vertices 0 and 1 near (0, 0.5, 0)"
};

/// The faults of the mesh, one finding for each kind, in the order above. Precondition: indices are valid.
std::vector<MeshFinding> inspect(const TriangleMesh& mesh);

}  // namespace cloth
