// A contact as a constraint on values x of particles, which are either positions (m, impulses in kg m) or
// velocities (m/s, impulses in N s). The contact point is their weighted sum, sum w x, with
//     normal . (sum w x) >= bound
// Friction opposes the tangential change of the contact point from `rest`; the friction impulse is at most
// the friction coefficient times the normal impulse.
#pragma once

#include <array>
#include <vector>

#include "geometry/at.h"
#include "geometry/vec3_field.h"

namespace cloth {

struct ContactConstraint {
  int count = 0;
  std::array<int, 4> particle{};
  std::array<double, 4> weight{};  ///< negative for particles on the far side of a self-contact
  Vec3 normal{0, 1, 0};            ///< of length one
  double bound = 0;                ///< m or m/s
  Vec3 rest{0, 0, 0};              ///< m or m/s: value of the contact point at which friction is 0
  double friction = 0;             ///< coefficient
  double mobility = 0;             ///< sum of w^2 / m, 1/kg
  double normal_impulse = 0;       ///< accumulated, >= 0
  Vec3 friction_impulse{0, 0, 0};  ///< accumulated, tangential

  // Inlined always: compilers count Eigen's expressions as long.
  [[gnu::always_inline]] Vec3 point(const Vec3Field& value) const {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < count; ++k) sum += weight[at(k)] * value[at(particle[at(k)])];
    return sum;
  }
  /// Calls visit(i) for every particle i whose weight is not 0.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (int k = 0; k < count; ++k)
      if (weight[at(k)] != 0) visit(at(particle[at(k)]));
  }
  template <class Test>
  bool any_of(const Test& test) const {
    bool found = false;
    for_each([&](std::size_t i) { found = found || test(i); });
    return found;
  }
  /// The first particle that the contact can move, or -1.
  int first_free(const std::vector<double>& inverse_mass) const {
    for (int k = 0; k < count; ++k)
      if (weight[at(k)] != 0 && inverse_mass[at(particle[at(k)])] > 0) return particle[at(k)];
    return -1;
  }
};

/// Adds the effect of an impulse at the contact's point to `value`, of the particles that it moves alone.
[[gnu::always_inline]] inline void add_impulse(const ContactConstraint& contact,
                                               const std::vector<double>& inverse_mass, const Vec3& impulse,
                                               Vec3Field& value) {
  for (std::size_t k = 0; k < at(contact.count); ++k) {
    const auto i = at(contact.particle[k]);
    const double response = contact.weight[k] * inverse_mass[i];
    if (response != 0) value.add(i, response * impulse);
  }
}

double mobility_of(const ContactConstraint& contact, const std::vector<double>& inverse_mass);

/// Adds the effect of the accumulated impulses to `value`.
void apply_impulses(const ContactConstraint& contact, const std::vector<double>& inverse_mass,
                    Vec3Field& value);

}  // namespace cloth
