// Triangles of constant strain that stretch and shear as a material does, on any mesh. Green's strain of a
// triangle is linear in the squares of its edges, q_e = |d_e|^2 - L_e^2, and so its energy of St. Venant and
// Kirchhoff is a quadratic form of them (Delingette 2008, eq. 4, there for isotropic materials):
//
//     E = 1/2 sum_ef K_ef q_e q_f,   the force on the first end of edge e: 2 (sum_f K_ef q_f) d_e
//
// with K constant, so that a triangle is three edges that know of each other. Damping is that of the rates of
// q with t K in place of K, t a time.
#pragma once

#include <array>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "geometry/vec3_field.h"

namespace cloth {

/// Stiffness of a sheet in its plane in N/m: E/area = 1/2 (along_1 e_11^2 + along_2 e_22^2) + coupling e_11
/// e_22 + 1/2 shear (2 e_12)^2, e Green's strain, 1 and 2 two directions at right angles.
struct PlaneStiffness {
  double along_1 = 0, along_2 = 0, coupling = 0, shear = 0;
};

/// Edge e leads from corner e to corner (e + 1) mod 3.
struct MembraneTriangle {
  Triangle corner{};
  std::array<int, 3> spring{};               ///< the number of the spring along each edge
  std::array<double, 3> rest_square{};       ///< L^2 in m^2
  std::array<std::array<double, 3>, 3> k{};  ///< K in N/m^3
  bool operator==(const MembraneTriangle&) const = default;
};
using Membrane = std::vector<MembraneTriangle>;

/// A triangle whose corners lie at these places at rest, m, in the directions of `stiffness`. Precondition:
/// its area is not 0. `spring` is left to the caller.
MembraneTriangle membrane_triangle(const Triangle& corner, const std::array<Eigen::Vector2d, 3>& at_rest,
                                   const PlaneStiffness& stiffness);

/// sum of E in J.
double membrane_energy(const Membrane& membrane, const Vec3Field& position);

/// force += -dE/dx in N.
void add_membrane_force(const Membrane& membrane, const Vec3Field& position, Vec3Field& force);

/// What every edge's share 2 sum_f K_ef q_f of its triangle's force is, in N/m: visit(spring, share).
template <class Visit>
void for_each_edge_tension(const Membrane& membrane, const Vec3Field& position, Visit visit);

/// product += scale times how J^T K J velocity changes, J alone, when the positions move by `direction`.
void add_membrane_turning(const Membrane& membrane, double scale, const Vec3Field& position,
                          const Vec3Field& velocity, const Vec3Field& direction, Vec3Field& product);

/// N/m of every edge of a triangle: springs of that stiffness in every direction are at least as stiff as it,
/// as long as no edge is longer than `covered_stretch` times its rest length. Triangles have no bound beyond:
/// they get stiffer the more they are stretched.
inline constexpr double covered_stretch = 1.1;
std::array<double, 3> edge_bounds(const MembraneTriangle& triangle);
/// The largest of them; 0 without triangles.
double stiffest_edge(const Membrane& membrane);

/// The vector of edge e and how it changes.
inline Vec3 edge_of(const MembraneTriangle& t, std::size_t e, const Vec3Field& field) {
  return field[at(t.corner[(e + 1) % 3])] - field[at(t.corner[e])];
}

/// sum_f K_ef q_f for e = 0, 1, 2.
inline std::array<double, 3> times_k(const MembraneTriangle& t, const std::array<double, 3>& q) {
  std::array<double, 3> product{};
  for (std::size_t e = 0; e < 3; ++e)
    for (std::size_t f = 0; f < 3; ++f) product[e] += t.k[e][f] * q[f];
  return product;
}

/// q at `position`.
inline std::array<double, 3> square_changes(const MembraneTriangle& t, const Vec3Field& position) {
  std::array<double, 3> q{};
  for (std::size_t e = 0; e < 3; ++e) q[e] = edge_of(t, e, position).squaredNorm() - t.rest_square[e];
  return q;
}

template <class Visit>
void for_each_edge_tension(const Membrane& membrane, const Vec3Field& position, Visit visit) {
  for (const MembraneTriangle& t : membrane) {
    const std::array<double, 3> tension = times_k(t, square_changes(t, position));
    for (std::size_t e = 0; e < 3; ++e) visit(at(t.spring[e]), 2 * tension[e]);
  }
}

/// J^T K J as a sum over pairs of edges of a triangle: visit(t, e, f, 4 K_ef); its part is the block weight
/// d_e d_f^T between the differences of both edges' ends.
template <class Visit>
void for_each_edge_pair(const Membrane& membrane, Visit visit) {
  for (const MembraneTriangle& t : membrane)
    for (std::size_t e = 0; e < 3; ++e)
      for (std::size_t f = 0; f < 3; ++f) visit(t, e, f, 4 * t.k[e][f]);
}

}  // namespace cloth
