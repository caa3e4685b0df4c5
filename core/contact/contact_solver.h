// Contact as inequalities with friction, solved one after the other until nothing changes (projected
// Gauss-Seidel; Erleben, "Stable, robust, and versatile multibody dynamics animation", 2005; the friction of
// positions as in Mueller et al., "Position based dynamics", 2007).
//
// A contact asks of the point sum w x of its particles
//     normal . (sum w x) >= bound
// and rubs against every change across the normal from `rest`, with up to friction times its push. The same
// serves positions (m; pushes in kg m) and velocities (m/s; pushes in N s).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "cloth/vec3_field.h"

namespace cloth {

struct ContactConstraint {
  int count = 0;
  std::array<int, 4> particle{};
  std::array<double, 4> weight{};  ///< negative on the other side of a cloth that touches itself
  Vec3 normal{0, 1, 0};
  double bound = 0;
  Vec3 rest{0, 0, 0};
  double friction = 0;
  double mobility = 0;             ///< sum of w^2 / m, 1/kg
  double normal_impulse = 0;       ///< along the normal so far, >= 0
  double normal_load = 0;          ///< a push that friction may count on in any case
  Vec3 friction_impulse{0, 0, 0};  ///< across it

  Vec3 point(const Vec3Field& value) const {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < count; ++k)
      sum += weight[static_cast<std::size_t>(k)] *
             value[static_cast<std::size_t>(particle[static_cast<std::size_t>(k)])];
    return sum;
  }
};

double mobility_of(const ContactConstraint& contact, const std::vector<double>& inverse_mass);

/// Adds what the present pushes and rubs do.
void apply_impulses(const ContactConstraint& contact, const std::vector<double>& inverse_mass,
                    Vec3Field& value);

/// At most `sweeps` over all, in their order; ends where no point was moved by more than `tolerance`.
/// Contacts of which no particle can move are left out. Returns the sweeps.
int solve_contacts(std::span<ContactConstraint> contacts, const std::vector<double>& inverse_mass, int sweeps,
                   double tolerance, Vec3Field& value);

}  // namespace cloth
