#include "cloth/membrane.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace cloth {
namespace {

/// dq of every edge where its ends move by `direction`.
std::array<double, 3> rates(const MembraneTriangle& t, const Vec3Field& position,
                            const Vec3Field& direction) {
  std::array<double, 3> rate{};
  for (std::size_t e = 0; e < 3; ++e) rate[e] = 2 * edge_of(t, e, position).dot(edge_of(t, e, direction));
  return rate;
}

/// Adds `push` to the end of an edge and takes it from its beginning.
void add_to_ends(const MembraneTriangle& t, std::size_t e, const Vec3& push, Vec3Field& to) {
  to.add(at(t.corner[e]), -push);
  to.add(at(t.corner[(e + 1) % 3]), push);
}

}  // namespace

MembraneTriangle membrane_triangle(const Triangle& corner, const std::array<Eigen::Vector2d, 3>& at_rest,
                                   const PlaneStiffness& stiffness) {
  MembraneTriangle t{.corner = corner};
  Eigen::Matrix3d squares;  // of the edges, from e_11, e_22 and 2 e_12
  for (std::size_t e = 0; e < 3; ++e) {
    const Eigen::Vector2d d = at_rest[(e + 1) % 3] - at_rest[e];
    t.rest_square[e] = d.squaredNorm();
    squares.row(static_cast<Eigen::Index>(e)) << 2 * d.x() * d.x(), 2 * d.y() * d.y(), 2 * d.x() * d.y();
  }
  Eigen::Matrix3d c;
  c << stiffness.along_1, stiffness.coupling, 0, stiffness.coupling, stiffness.along_2, 0, 0, 0,
      stiffness.shear;
  const Eigen::Vector2d u = at_rest[1] - at_rest[0], v = at_rest[2] - at_rest[0];
  const double area = 0.5 * std::abs(u.x() * v.y() - u.y() * v.x());
  const Eigen::Matrix3d strain = squares.inverse();
  const Eigen::Matrix3d k = area * strain.transpose() * c * strain;
  for (std::size_t e = 0; e < 3; ++e)
    for (std::size_t f = 0; f < 3; ++f) {
      const auto i = static_cast<Eigen::Index>(e), j = static_cast<Eigen::Index>(f);
      t.k[e][f] = 0.5 * (k(i, j) + k(j, i));
    }
  return t;
}

double membrane_energy(const Membrane& membrane, const Vec3Field& position) {
  double sum = 0;
  for (const MembraneTriangle& t : membrane) {
    const std::array<double, 3> q = square_changes(t, position), kq = times_k(t, q);
    sum += 0.5 * (q[0] * kq[0] + q[1] * kq[1] + q[2] * kq[2]);
  }
  return sum;
}

void add_membrane_force(const Membrane& membrane, const Vec3Field& position, Vec3Field& force) {
  for (const MembraneTriangle& t : membrane) {
    const std::array<double, 3> tension = times_k(t, square_changes(t, position));
    for (std::size_t e = 0; e < 3; ++e) add_to_ends(t, e, -2 * tension[e] * edge_of(t, e, position), force);
  }
}

void add_membrane_turning(const Membrane& membrane, double scale, const Vec3Field& position,
                          const Vec3Field& velocity, const Vec3Field& direction, Vec3Field& product) {
  for (const MembraneTriangle& t : membrane) {
    std::array<double, 3> change{};
    for (std::size_t e = 0; e < 3; ++e) change[e] = 2 * edge_of(t, e, direction).dot(edge_of(t, e, velocity));
    const std::array<double, 3> share = times_k(t, rates(t, position, velocity)),
                                share_change = times_k(t, change);
    for (std::size_t e = 0; e < 3; ++e)
      add_to_ends(
          t, e, 2 * scale * (share[e] * edge_of(t, e, direction) + share_change[e] * edge_of(t, e, position)),
          product);
  }
}

/// Of J^T K J, with a = d_e . u_e and |a| <= s L_e |u_e| at a stretch of s: 2 |K_ef a b| <= |K_ef| (a^2
/// L_f/L_e + b^2 L_e/L_f). Of the tension: 2 |K_ef| (s^2 - 1) L_f^2.
std::array<double, 3> edge_bounds(const MembraneTriangle& t) {
  constexpr double square = covered_stretch * covered_stretch;
  std::array<double, 3> bound{};
  for (std::size_t e = 0; e < 3; ++e)
    for (std::size_t f = 0; f < 3; ++f)
      bound[e] += std::abs(t.k[e][f]) * (4 * square * std::sqrt(t.rest_square[e] * t.rest_square[f]) +
                                         2 * (square - 1) * t.rest_square[f]);
  return bound;
}

double stiffest_edge(const Membrane& membrane) {
  double stiffest = 0;
  for (const MembraneTriangle& t : membrane)
    for (const double bound : edge_bounds(t)) stiffest = std::max(stiffest, bound);
  return stiffest;
}

}  // namespace cloth
