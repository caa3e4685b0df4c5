// Contact constraints with Coulomb friction, solved by projected Gauss-Seidel (Erleben 2005); friction on
// positions as in position-based dynamics (Müller et al. 2007).
//
// The contact point is the weighted sum of its particles' values, sum w x, with the constraint
//     normal . (sum w x) >= bound
// The values x are either positions (m, impulses in kg m) or velocities (m/s, impulses in N s). Friction
// opposes the tangential change of the contact point from `rest`; the friction impulse is at most the
// friction coefficient times the normal impulse.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "contact/relax_kernels.h"
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

  Vec3 point(const Vec3Field& value) const {
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

double mobility_of(const ContactConstraint& contact, const std::vector<double>& inverse_mass);

/// Adds the effect of the accumulated impulses to `value`.
void apply_impulses(const ContactConstraint& contact, const std::vector<double>& inverse_mass,
                    Vec3Field& value);

/// When a solve ends.
struct SolveLimits {
  int sweeps = 100;      ///< at most so many
  double tolerance = 0;  ///< m or m/s: of no particle did a sweep change the value by more
};

/// Sweeps over the contacts, in their order. Contacts of the same particles hand an impulse to and
/// fro for ever while nothing moves, so that a solve ends by what a whole sweep has changed at the particles
/// and not by what single contacts have. A contact whose particles have no other is solved by one relaxation.
/// Of the others, those whose particles did not move in the last sweep are left out of the next, except in
/// every fourth sweep and in the one that ends the solve.
class ContactSolver {
 public:
  /// In and out: `value` contains the effect of the contacts' impulses. Contacts without a free particle are
  /// skipped. Returns the sweeps.
  int solve(std::span<ContactConstraint> contacts, const std::vector<double>& inverse_mass,
            const SolveLimits& limits, Vec3Field& value);

 private:
  void count_contacts(std::span<const ContactConstraint> contacts, const std::vector<double>& inverse_mass);
  void pack(const ContactConstraint& contact, const std::vector<double>& inverse_mass,
            const Vec3Field& value);
  int slot_of(int particle, const Vec3Field& value);
  void order_moved();
  int sweep(const SolveLimits& limits);
  void unpack(std::span<ContactConstraint> contacts, Vec3Field& value);

  std::vector<int> slot_;         ///< of each particle, -1: no packed contact has it
  std::vector<int> contacts_of_;  ///< of each particle, number of contacts that move it
  std::vector<int> particle_;     ///< of each slot; of slot 0, which stands for none, -1
  std::vector<ContactValue> values_, before_;
  std::vector<unsigned char> moved_;     ///< of each slot, in the last sweep
  std::vector<ContactRow> rows_;         ///< contacts that share particles with others
  std::vector<std::size_t> contact_of_;  ///< of each row
  std::vector<int> all_, active_;        ///< rows
};

}  // namespace cloth
