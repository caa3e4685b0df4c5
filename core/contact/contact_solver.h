// Contact constraints with Coulomb friction, solved by projected Gauss-Seidel (Erleben 2005); friction on
// positions as in position-based dynamics (Müller et al. 2007).
//
// A constraint on the point sum w x of its particles:
//     normal . (sum w x) >= bound
// Friction opposes the tangential displacement of that point from `rest`; its impulse is at most the friction
// coefficient times the normal impulse. Values are positions (m, impulses in kg m) or velocities (m/s,
// impulses in N s).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/vec3_field.h"

namespace cloth {

struct ContactConstraint {
  int count = 0;
  std::array<int, 4> particle{};
  std::array<double, 4> weight{};  ///< negative for particles on the far side of a self-contact
  Vec3 normal{0, 1, 0};
  double bound = 0;
  Vec3 rest{0, 0, 0};
  double friction = 0;
  double mobility = 0;             ///< sum of w^2 / m, 1/kg
  double normal_impulse = 0;       ///< accumulated, >= 0
  double normal_load = 0;          ///< least normal impulse that bounds friction
  Vec3 friction_impulse{0, 0, 0};  ///< accumulated, tangential

  Vec3 point(const Vec3Field& value) const {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < count; ++k)
      sum += weight[static_cast<std::size_t>(k)] *
             value[static_cast<std::size_t>(particle[static_cast<std::size_t>(k)])];
    return sum;
  }
};

double mobility_of(const ContactConstraint& contact, const std::vector<double>& inverse_mass);

/// Adds the effect of the accumulated impulses to `value`.
void apply_impulses(const ContactConstraint& contact, const std::vector<double>& inverse_mass,
                    Vec3Field& value);

/// At most `sweeps` sweeps over the contacts in their order; ends when no point moved by more than
/// `tolerance`. Contacts without a free particle are skipped. Returns the sweeps.
int solve_contacts(std::span<ContactConstraint> contacts, const std::vector<double>& inverse_mass, int sweeps,
                   double tolerance, Vec3Field& value);

}  // namespace cloth
