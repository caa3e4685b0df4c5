// A triangle of a mesh and those across its edges are a patch. Its surface is the quadratic one through the
// patch's corners, the others unfolded into the triangle's plane; every quadratic surface is met exactly,
// whatever the triangles' shapes.
//
// At a free edge a corner is missing: the surface is then that of least bending energy through those that
// there are, which has no moment across the edge. Where a triangle of pinned corners is across an edge, the
// cloth is clamped there: the surface has that triangle's slope in the middle of the edge.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace cloth {

/// What is across edge e of a triangle, which goes from corner e to corner e + 1.
struct AcrossEdge {
  int triangle = -1;  ///< -1: none, a free edge, or one where more than two triangles meet
  int edge = 0;       ///< the same edge there
};
using TriangleNeighbours = std::vector<std::array<AcrossEdge, 3>>;
TriangleNeighbours neighbours_of(const std::vector<Triangle>& triangles);

/// A triangle's corners in its own plane, in m.
struct FlatTriangle {
  Triangle corner{};
  std::array<Eigen::Vector2d, 3> place;  ///< from the middle, along two unit vectors
  double area = 0;                       ///< m^2; 0: it has no plane

  Eigen::Vector2d middle_of(std::size_t e) const { return 0.5 * (place[e] + place[(e + 1) % 3]); }
  double length_of(std::size_t e) const { return (place[(e + 1) % 3] - place[e]).norm(); }
  /// Unit vector in the plane, away from the triangle.
  Eigen::Vector2d outward_of(std::size_t e) const;
  /// The two components, 1/m, of the slope of the plane through the corners: rows that their positions are
  /// multiplied by.
  Eigen::Matrix<double, 2, 3> slope() const;
};
FlatTriangle flat_triangle(const TriangleMesh& mesh, const Triangle& triangle,
                           const std::array<Vec3, 2>& axes);

/// The surface as weights of the positions of the patch's corners, the triangle's own first.
struct PatchSurface {
  std::vector<int> corner;
  Eigen::Matrix<double, 2, Eigen::Dynamic> slope;      ///< in the triangle's middle, 1/m
  Eigen::Matrix<double, 3, Eigen::Dynamic> curvature;  ///< k_11, k_22, k_12 in 1/m of positions in m: 1/m^2

  /// Of the slope along the unit vector `direction` at `place`.
  Eigen::RowVectorXd slope_at(const Eigen::Vector2d& place, const Eigen::Vector2d& direction) const;
};

/// `weight` of the squares of k_11, k_22, k_12 in the bending energy; `pinned` of every vertex.
PatchSurface patch_surface(const TriangleMesh& mesh, const std::vector<std::uint8_t>& pinned,
                           const FlatTriangle& triangle, const std::array<AcrossEdge, 3>& across,
                           const Eigen::Vector3d& weight);

}  // namespace cloth
