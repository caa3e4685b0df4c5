// Groups of particles that are connected by contacts, directly or through other particles (union-find).
#pragma once

#include <numeric>
#include <span>
#include <vector>

#include "contact/contact_solver.h"
#include "geometry/at.h"

namespace cloth {

class Islands {
 public:
  /// Particles that cannot move do not connect.
  Islands(std::span<const ContactConstraint> contacts, const std::vector<double>& inverse_mass)
      : parent_(inverse_mass.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (const ContactConstraint& contact : contacts) {
      const int first = first_free(contact, inverse_mass);
      for (int k = 0; k < contact.count; ++k)
        if (const int i = contact.particle[at(k)]; inverse_mass[at(i)] > 0 && contact.weight[at(k)] != 0)
          parent_[at(of(i))] = of(first);
    }
  }

  /// The particle that represents the island of `i`.
  int of(int i) {
    while (parent_[at(i)] != i) i = parent_[at(i)] = parent_[at(parent_[at(i)])];
    return i;
  }

  /// A particle that the contact can move, or -1.
  static int first_free(const ContactConstraint& contact, const std::vector<double>& inverse_mass) {
    for (int k = 0; k < contact.count; ++k)
      if (const int i = contact.particle[at(k)]; inverse_mass[at(i)] > 0 && contact.weight[at(k)] != 0)
        return i;
    return -1;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace cloth
