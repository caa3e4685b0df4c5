// The block-diagonal part of m + weight D, one 3x3 block for each particle. It is applied and solved strip by
// strip: few enough particles at a time that their data stay in the first-level cache from one loop to the
// next.
#pragma once

#include <algorithm>
#include <array>
#include <type_traits>
#include <vector>

#include "cloth/cloth_system.h"
#include "cloth/sums.h"
#include "forces/force.h"

namespace cloth {

inline constexpr std::size_t particles_of_strip = 256;

/// Some consecutive particles of a field.
template <class Number>
struct Strip {
  std::array<Number*, 3> axis;
  std::size_t count;

  operator Strip<const Number>() const requires(!std::is_const_v<Number>) {
    return {{axis[0], axis[1], axis[2]}, count};
  }
};

inline Strip<double> strip_of(Vec3Field& field, std::size_t first, std::size_t count) {
  return {{field.x() + first, field.y() + first, field.z() + first}, count};
}

inline Strip<const double> read_strip(const Vec3Field& field, std::size_t first, std::size_t count) {
  return {{field.x() + first, field.y() + first, field.z() + first}, count};
}

/// visit(first, count) for one strip after the other
template <class Visit>
void for_each_strip(std::size_t size, Visit visit) {
  for (std::size_t first = 0; first < size; first += particles_of_strip)
    visit(first, std::min(particles_of_strip, size - first));
}

inline double dot(const Strip<const double>& a, const Strip<double>& b) {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    sum += ordered_sum(a.count, [p = a.axis[axis], q = b.axis[axis]](std::size_t i) { return p[i] * q[i]; });
  return sum;
}

/// The blocks L = (m + w a) I + w b n n^T: w the weight in s, a and b the coefficients `isotropic` and
/// `along_normal` of NodeDamping, n the unit normal, or zero where there is none.
class NodeMatrix {
 public:
  /// `inverse` is used as scratch. All arguments must outlive the matrix.
  NodeMatrix(const ClothSystem& system, double weight, const NodeDamping& damping,
             std::vector<double>& inverse)
      : mass_(system.mass.data()),
        isotropic_(damping.isotropic.scaled(weight)),
        along_(damping.along_normal.scaled(weight)),
        normal_(damping.normal) {
    inverse.resize(system.mass.size());
    for (std::size_t i = 0; i < inverse.size(); ++i)
      inverse[i] = system.inverse_mass[i] == 0 ? 0 : 1 / (mass_[i] + isotropic_.of(mass_[i]));
    inverse_ = inverse.data();
  }

  /// v = L^-1 r after Sherman and Morrison (1950), 0 where pinned
  void solve(std::size_t first, const Strip<const double>& r, const Strip<double>& v) const {
    const double* inverse = inverse_ + first;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double* from = r.axis[axis];
      double* to = v.axis[axis];
      for (std::size_t i = 0; i < v.count; ++i) to[i] = inverse[i] * from[i];
    }
    if (!normal_) return;
    const double *nx = normal_->x() + first, *ny = normal_->y() + first, *nz = normal_->z() + first;
    double *vx = v.axis[0], *vy = v.axis[1], *vz = v.axis[2];
    for (std::size_t i = 0; i < v.count; ++i) {
      const double share = along_.of(mass_[first + i]) * inverse[i];
      const double correction = share / (1 + share) * (nx[i] * vx[i] + ny[i] * vy[i] + nz[i] * vz[i]);
      vx[i] -= correction * nx[i], vy[i] -= correction * ny[i], vz[i] -= correction * nz[i];
    }
  }

  /// r -= length (L d + weight q)
  void subtract_product(std::size_t first, double length, double weight, const Strip<const double>& d,
                        const Strip<const double>& q, const Strip<double>& r) const {
    const double* mass = mass_ + first;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double *from = d.axis[axis], *product = q.axis[axis];
      double* to = r.axis[axis];
      for (std::size_t i = 0; i < r.count; ++i)
        to[i] -= length * ((mass[i] + isotropic_.of(mass[i])) * from[i] + weight * product[i]);
    }
    if (!normal_) return;
    const double *nx = normal_->x() + first, *ny = normal_->y() + first, *nz = normal_->z() + first;
    const double *dx = d.axis[0], *dy = d.axis[1], *dz = d.axis[2];
    double *rx = r.axis[0], *ry = r.axis[1], *rz = r.axis[2];
    for (std::size_t i = 0; i < r.count; ++i) {
      const double along = length * along_.of(mass[i]) * (nx[i] * dx[i] + ny[i] * dy[i] + nz[i] * dz[i]);
      rx[i] -= along * nx[i], ry[i] -= along * ny[i], rz[i] -= along * nz[i];
    }
  }

  /// d L d
  double square(std::size_t first, const Strip<const double>& d) const {
    const double *dx = d.axis[0], *dy = d.axis[1], *dz = d.axis[2];
    double sum = ordered_sum(d.count, [=, mass = mass_ + first, a = isotropic_](std::size_t i) {
      return (mass[i] + a.of(mass[i])) * (dx[i] * dx[i] + dy[i] * dy[i] + dz[i] * dz[i]);
    });
    if (normal_)
      sum += ordered_sum(d.count, [=, mass = mass_ + first, b = along_, nx = normal_->x() + first,
                                   ny = normal_->y() + first, nz = normal_->z() + first](std::size_t i) {
        const double along = nx[i] * dx[i] + ny[i] * dy[i] + nz[i] * dz[i];
        return b.of(mass[i]) * along * along;
      });
    return sum;
  }

 private:
  const double *mass_, *inverse_;
  NodeCoefficient isotropic_, along_;
  const Vec3Field* normal_;
};

/// Scratch memory for one strip.
class OwnStrip {
 public:
  Strip<double> of(std::size_t count) {
    return {{values_[0].data(), values_[1].data(), values_[2].data()}, count};
  }

 private:
  std::array<std::array<double, particles_of_strip>, 3> values_;
};

}  // namespace cloth
