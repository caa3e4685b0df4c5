// What contact must prevent, found exactly and without hierarchies: features that cross. It shares nothing
// with the engine's contact or its geometry but the values that they are given: a pair is dismissed only
// where bounding boxes have no point in common (box_sweep.h, or by looking at all pairs), and signs are exact
// (exact_sign.h).
//
// Touching counts as crossing: two features cross if they have a point in common, were it a single one. A
// triangle without area is what its edges are.
#pragma once

#include <string>

#include "geometry/triangle_mesh.h"

namespace cloth::test {

struct Count {
  int number = 0;
  std::string
      first;  ///< "edge 3-4 of the cloth and triangle 17 of the obstacle"; empty where the number is 0
};

/// The triangles (a,d,c) and (a,c,b) of a grid's cells, a = (r,c), b = (r,c+1), c = (r+1,c+1), d = (r+1,c).
TriangleMesh grid_triangles(int rows, int columns, const Vec3Field& position);

/// A box with its triangles facing outward: center + axes u, |u_k| <= half_k.
TriangleMesh box_triangles(const Vec3& center, const Eigen::Matrix3d& axes, const Vec3& half);

bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);
bool segments_meet(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// How pairs whose bounding boxes meet are found; the answer is the same.
enum class Search { sweep, all_pairs };

/// Pairs of an edge of the one and a triangle of the other that cross, either way.
Count crossings(const TriangleMesh& cloth, const TriangleMesh& obstacle, Search search = Search::sweep);

/// Pairs of triangles of the cloth that cross: an edge of the one and the other. Of two that share one vertex
/// only the edges opposite to it are looked at; two that share an edge are not (they cross only where they
/// lie in each other's plane exactly).
Count self_crossings(const TriangleMesh& cloth, Search search = Search::sweep);

/// Triangles no further from the centre than the radius. In long double: where the distance differs from the
/// radius by less than some 1e-18 of itself and of the triangle's size (divided by the sine of its smallest
/// angle) rounding decides.
Count triangles_in_sphere(const TriangleMesh& cloth, const Vec3& center, double radius);

/// Triangles that have a point in common with the solid inside a closed mesh (box_triangles, any obstacle
/// that is closed).
Count triangles_in_solid(const TriangleMesh& cloth, const TriangleMesh& closed);

/// Vertices on or below the plane: on the side away from its normal.
Count vertices_below_plane(const TriangleMesh& cloth, const Vec3& point, const Vec3& normal);

/// How often a closed mesh winds around a point: 1 inside of one whose triangles face outward, -1 if they
/// face inward, 0 outside. A point of the surface itself counts to one side of it. Of an open mesh it is the
/// sum, over the triangles that the ray from the point along +`axis` passes, of 1 for those that face along
/// it and -1 for the others: a cloth particle is on the other side of a sheet across that axis where the sum
/// differs.
int winding_number(const TriangleMesh& mesh, const Vec3& point, int axis = 2);

/// Particles of a cloth that are inside of a closed mesh: that have passed through its surface.
Count vertices_inside(const TriangleMesh& cloth, const TriangleMesh& closed);

/// Particles that a straight way from `before` to `after` leads through a triangle of the mesh.
Count ways_through(const TriangleMesh& before, const TriangleMesh& after, const TriangleMesh& mesh);

}  // namespace cloth::test
