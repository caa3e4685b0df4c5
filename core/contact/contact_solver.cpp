#include "contact/contact_solver.h"

#include <algorithm>
#include <cmath>

namespace cloth {
namespace {

void add_push(const ContactConstraint& contact, const std::vector<double>& inverse_mass, const Vec3& push,
              Vec3Field& value) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
    const auto i = static_cast<std::size_t>(contact.particle[k]);
    value.add(i, contact.weight[k] * inverse_mass[i] * push);
  }
}

/// How far the contact's point was moved.
double relax(ContactConstraint& contact, const std::vector<double>& inverse_mass, Vec3Field& value) {
  const Vec3 point = contact.point(value);
  const double missing = contact.bound - contact.normal.dot(point);
  const double push = std::max(contact.push + missing / contact.mobility, 0.0) - contact.push;
  if (push == 0 && contact.push == 0 && contact.pressed == 0) return 0;
  contact.push += push;
  Vec3 total = push * contact.normal;
  if (contact.friction > 0) {
    const Vec3 slip = point - contact.rest;
    const Vec3 across = slip - contact.normal.dot(slip) * contact.normal;
    Vec3 rub = contact.rub - across / contact.mobility;
    const double most = contact.friction * std::max(contact.push, contact.pressed), wanted = rub.norm();
    if (wanted > most) rub *= most / wanted;
    total += rub - contact.rub;
    contact.rub = rub;
  }
  add_push(contact, inverse_mass, total, value);
  return contact.mobility * total.norm();
}

}  // namespace

double mobility_of(const ContactConstraint& contact, const std::vector<double>& inverse_mass) {
  double mobility = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k)
    mobility +=
        contact.weight[k] * contact.weight[k] * inverse_mass[static_cast<std::size_t>(contact.particle[k])];
  return mobility;
}

void apply_pushes(const ContactConstraint& contact, const std::vector<double>& inverse_mass,
                  Vec3Field& value) {
  add_push(contact, inverse_mass, contact.push * contact.normal + contact.rub, value);
}

int solve_contacts(std::span<ContactConstraint> contacts, const std::vector<double>& inverse_mass, int sweeps,
                   double tolerance, Vec3Field& value) {
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    double furthest = 0;
    for (ContactConstraint& contact : contacts)
      if (contact.mobility > 0) furthest = std::max(furthest, relax(contact, inverse_mass, value));
    if (!(furthest > tolerance)) return sweep + 1;
  }
  return sweeps;
}

}  // namespace cloth
