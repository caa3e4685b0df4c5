#include "contact/contact_solver.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <limits>

#include "kernels/in_shares.h"

namespace cloth {
namespace {

/// m or m/s, of a contact's point beyond its bound; negative where it is violated.
double slack_of(const ContactConstraint& contact, const Vec3Field& value) {
  return contact.normal.dot(contact.point(value)) - contact.bound;
}

/// Of a contact whose particles have no other, this is the solution. Particles of weight 0 are not looked at:
/// another thread may move them.
void relax_alone(ContactConstraint& contact, const std::vector<double>& inverse_mass, Vec3Field& value) {
  Vec3 point = Vec3::Zero();
  for (std::size_t k = 0; k < at(contact.count); ++k)
    if (contact.weight[k] != 0) point += contact.weight[k] * value[at(contact.particle[k])];
  const double inverse_mobility = 1 / contact.mobility, level = contact.normal.dot(point);
  const double change = std::max(contact.normal_impulse + (contact.bound - level) * inverse_mobility, 0.0) -
                        contact.normal_impulse;
  if (change == 0 && contact.normal_impulse == 0) return;
  contact.normal_impulse += change;
  Vec3 total = change * contact.normal;
  if (contact.friction > 0) {
    const Vec3 slip = point - contact.rest;
    const Vec3 across = slip - contact.normal.dot(slip) * contact.normal;
    Vec3 impulse = contact.friction_impulse - inverse_mobility * across;
    const double most = contact.friction * contact.normal_impulse, square = impulse.squaredNorm();
    if (square > most * most) impulse *= most / std::sqrt(square);
    total += impulse - contact.friction_impulse;
    contact.friction_impulse = impulse;
  }
  add_impulse(contact, inverse_mass, total, value);
}

}  // namespace

/// The chosen contacts.
void ContactSolver::pack(std::span<const ContactConstraint> contacts,
                         const std::vector<double>& inverse_mass) {
  contacts_of_.assign(inverse_mass.size(), 0);
  for (std::size_t c = 0; c < contacts.size(); ++c)
    if (is_chosen_[c])
      contacts[c].for_each([&](std::size_t i) { contacts_of_[i] += inverse_mass[i] > 0 ? 1 : 0; });
  alone_.clear(), batches_.clear(inverse_mass.size());
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    if (!is_chosen_[c]) continue;
    if (contacts[c].any_of([&](std::size_t i) { return contacts_of_[i] > 1; }))
      batches_.add(c, contacts[c], inverse_mass);
    else
      alone_.push_back(c);
  }
  batches_.arrange(contacts, inverse_mass);
}

int ContactSolver::solve_again(std::span<ContactConstraint> contacts, const std::vector<double>& inverse_mass,
                               const SolveLimits& limits, Vec3Field& value) {
  assert(contacts.size() == is_chosen_.size());
  in_shares(team_, alone_.size(), least_contacts, [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) relax_alone(contacts[alone_[k]], inverse_mass, value);
  });
  return batches_.is_empty() ? 1 : batches_.solve(contacts, limits, value);
}

int ContactSolver::solve(std::span<ContactConstraint> contacts, const std::vector<double>& inverse_mass,
                         const SolveLimits& limits, Vec3Field& value) {
  constexpr int most_choices = 4;
  is_chosen_.assign(contacts.size(), 0);
  alone_.clear(), batches_.clear(inverse_mass.size());
  const auto choose = [&](double within) {
    std::atomic<bool> any = false;
    in_shares(team_, contacts.size(), least_contacts, [&](int, std::size_t begin, std::size_t end) {
      bool any_here = false;
      for (std::size_t c = begin; c < end; ++c) {
        if (is_chosen_[c] || !(contacts[c].mobility > 0)) continue;
        is_chosen_[c] = contacts[c].normal_impulse > 0 || !(slack_of(contacts[c], value) > within);
        any_here = any_here || is_chosen_[c];
      }
      if (any_here) any = true;
    });
    return any.load();
  };
  int sweeps = 0;
  double within = limits.margin;
  for (int choices = 1; choose(within); ++choices) {
    within = choices < most_choices ? -limits.tolerance : std::numeric_limits<double>::infinity();
    pack(contacts, inverse_mass);
    sweeps = solve_again(contacts, inverse_mass, limits, value);
  }
  return sweeps;
}

}  // namespace cloth
