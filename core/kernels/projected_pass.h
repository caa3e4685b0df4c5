// The interface of XPBD's visits of a cloth's elements (integrators/xpbd.h) by the kernels: bending, sliders
// and triangles. Those of springs are in local_pass.h. Plain data only, for the reason given in grid_pass.h.
//
// Fields of particles are 4-vectors here, x y z 0 of one particle after the other, 64-byte aligned, so that
// an index reads all of a particle at once; indices are multiplied by 4.
#pragma once

namespace cloth::kernels {

/// What visits move, and how it answers.
struct ProjectedParticles {
  const double* position = nullptr;  ///< m, at the start of the step; 4-vectors
  double* velocity = nullptr;        ///< m/s, in place; 4-vectors
  const double* mobility = nullptr;  ///< w, 1/kg, of each particle; 0 where pinned
  const double* drag = nullptr;      ///< b, kg^-1/2, 4-vectors: W = w I - b b^T; null: none
  double step = 0;                   ///< s
  bool measures = false;             ///< whether largest_change is wanted
  double largest_change = 0;         ///< output: squared, of a particle's velocity by a visit, (m/s)^2
};

/// Elements that know of their particles' places only sum c x, in the order of visits.
struct SumElements {
  int count = 0;
  const int *begin = nullptr, *particle = nullptr;  ///< element e has the points begin[e] to begin[e + 1] - 1
  const double* coefficient = nullptr;              ///< c, of each point
  const double *stiffness = nullptr, *give = nullptr;  ///< of each element: k, and G = sum c^2 w
  double* impulse = nullptr;  ///< 4-vectors, in place; of a slider the first number alone
};

/// k in N/m, impulses in N s.
struct BendingProjection : SumElements {
  double time = 0;  ///< s, of damping
};

/// k and `most` (yield) times the area, in N m^3 and N m^2; impulses in N s m^2.
struct SliderProjection : SumElements {
  const double* normal = nullptr;  ///< 4-vectors
  const double *slip = nullptr, *most = nullptr;
};

/// Eight triangles are a block, of which none shares a particle with another. Numbers: L^2 of the three edges
/// in m^2, w of the corners in 1/kg, and the factor of K = L L^T: L_00, L_10, L_20, L_11, L_21, L_22 in
/// (N/m^3)^1/2.
inline constexpr int projected_triangle_numbers = 12;
struct TriangleProjection {
  int blocks = 0;
  const int* corner = nullptr;      ///< [block][corner][lane]
  const double* numbers = nullptr;  ///< [block][number][lane]; 0 where there is no triangle
  double* impulse = nullptr;        ///< N s, [block][corner][axis][lane], in place
  double time = 0;                  ///< s, of damping
};

struct ElementProjection {
  BendingProjection bending;
  SliderProjection sliders;
  TriangleProjection triangles;
};

}  // namespace cloth::kernels
