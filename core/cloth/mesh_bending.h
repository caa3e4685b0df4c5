// Bending elements (cloth/bending.h) of a triangle mesh. A triangle's curvature follows from the slopes of
// the surface in the middles of its edges, as in Morley's plate (Morley 1968):
//
//     kappa = 1/A sum_e L_e (s_e - p_e) n_e n_e^T
//
// L_e an edge's length, n_e its normal in the triangle's plane, p_e the slope of that plane along n_e and s_e
// the surface's, which both triangles at the edge share: the mean of the slopes that the quadratic surfaces
// of their patches (cloth/mesh_patch.h) have there. A quadratic surface is met exactly on every mesh, and a
// cloth of constant moment is in equilibrium on every mesh, since what an edge takes from one of its
// triangles it gives to the other: both together let the bending of irregular meshes converge with the square
// of the cells. Curvatures of patches alone, without shared slopes, are 4 to 16 % too soft there; hinges
// (Bergou et al. 2006) store three times a cylinder's energy, and one that depends on the direction where the
// mesh is not equilateral. The second derivative of the energy is constant.
//
// At a free edge the slope is that of no moment across it; at a clamp that of the pinned triangle.
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

/// `pinned` of every vertex. Triangles without area, and those whose corners are all pinned, have no
/// elements.
struct MeshBending {
  BendingRuns elements;
  BendingSliders sliders;
};
MeshBending mesh_bending(const TriangleMesh& mesh, const std::vector<std::uint8_t>& pinned,
                         const PlaneAxes& axes, const PlaneBending& bending, const PlaneFriction& friction);

}  // namespace cloth
