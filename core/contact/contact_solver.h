// Contact constraints with Coulomb friction, solved by projected Gauss-Seidel (Erleben 2005); friction on
// positions as in position-based dynamics (Müller et al. 2007).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contact/contact_batches.h"
#include "contact/contact_constraint.h"

namespace cloth {

class WorkerTeam;

/// Least number of contacts that is worth a thread of its own.
inline constexpr std::size_t least_contacts = 256;

/// Sweeps over the contacts, colour by colour. Contacts of the same particles hand an impulse to and
/// fro for ever while nothing moves, so that a solve ends by what a whole sweep has changed at the particles
/// and not by what single contacts have. A contact whose particles have no other is solved by one relaxation.
class ContactSolver {
 public:
  /// Null: one thread. Results do not depend on the team.
  void set_team(WorkerTeam* team) { team_ = team; }

  /// In and out: `value` contains the effect of the contacts' impulses. Contacts without a free particle are
  /// skipped. Where contacts that were left out (SolveLimits::margin) are violated, they are added and the
  /// solve goes on, at last with all. Returns the sweeps of the last of these solves.
  int solve(std::span<ContactConstraint> contacts, const std::vector<double>& inverse_mass,
            const SolveLimits& limits, Vec3Field& value);
  /// The contacts of the last solve, which left none out, with other values. Precondition: of the contacts
  /// nothing but the impulses has changed.
  int solve_again(std::span<ContactConstraint> contacts, const std::vector<double>& inverse_mass,
                  const SolveLimits& limits, Vec3Field& value);

 private:
  void pack(std::span<const ContactConstraint> contacts, const std::vector<double>& inverse_mass);

  WorkerTeam* team_ = nullptr;
  std::vector<std::uint8_t> is_chosen_;  ///< of each contact
  std::vector<int> contacts_of_;         ///< of each particle, number of chosen contacts that move it
  std::vector<std::size_t> alone_;       ///< chosen contacts whose particles have no other
  ContactBatches batches_;               ///< the others that are chosen
};

}  // namespace cloth
