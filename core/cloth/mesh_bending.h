// Bending elements (cloth/bending.h) of a triangle mesh. A triangle and those across its edges are a patch:
// its curvature is that of the quadratic surface through the patch's corners, the others unfolded into the
// triangle's plane. A quadratic surface is met exactly on every mesh, whatever its triangles' shapes, and the
// second derivative of the energy is constant. On regular meshes it is the curvature of the basic shell
// triangle (Oñate and Zárate 2000); the isometric bending of hinges (Bergou et al. 2006) stores three times a
// cylinder's energy and depends on the mesh's directions where it is not equilateral.
//
// At a free edge a corner is missing: the surface is then that of least bending energy through those that
// there are, which has no moment across the edge. Where a triangle of pinned corners is across an edge, the
// cloth is clamped there: the surface has that triangle's slope in the middle of the edge.
#pragma once

#include <cstdint>

#include "cloth/bending.h"
#include "cloth/bending_sliders.h"
#include "cloth/material.h"
#include "geometry/triangle_mesh.h"

namespace cloth {

/// E/area = 1/2 (along_1 k_11^2 + along_2 k_22^2 + 2 twist k_12^2) of the curvatures k; N m.
struct PlaneBending {
  double along_1 = 0, along_2 = 0, twist = 0;
};

/// Direction 1 at every triangle is `first` projected into it; where `first` stands across it, direction 2 is
/// `second` projected.
struct PlaneAxes {
  Vec3 first, second;
  /// Both directions as unit vectors of the triangle's plane.
  std::array<Vec3, 2> in(const TriangleMesh& mesh, const Triangle& triangle) const;
};

/// Half of the loops' widths along both directions, N, and the stiffness of their sliders, N m.
struct PlaneFriction {
  double yield_1 = 0, yield_2 = 0, stiffness_1 = 0, stiffness_2 = 0;
};

/// `pinned` of every vertex. Triangles without area, and those whose corners are all pinned, have no elements.
struct MeshBending {
  BendingRuns elements;
  BendingSliders sliders;
};
MeshBending mesh_bending(const TriangleMesh& mesh, const std::vector<std::uint8_t>& pinned,
                         const PlaneAxes& axes, const PlaneBending& bending, const PlaneFriction& friction);

}  // namespace cloth
