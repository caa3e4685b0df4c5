#include "contact/contact_solver.h"

#include <algorithm>

namespace cloth {
namespace {

void add_impulse(const ContactConstraint& contact, const std::vector<double>& inverse_mass,
                 const Vec3& impulse, Vec3Field& value) {
  for (std::size_t k = 0; k < at(contact.count); ++k) {
    const auto i = at(contact.particle[k]);
    value.add(i, contact.weight[k] * inverse_mass[i] * impulse);
  }
}

/// How far the contact's point was moved.
double relax(ContactConstraint& contact, const std::vector<double>& inverse_mass, Vec3Field& value) {
  const Vec3 point = contact.point(value);
  const double missing = contact.bound - contact.normal.dot(point);
  const double change =
      std::max(contact.normal_impulse + missing / contact.mobility, 0.0) - contact.normal_impulse;
  if (change == 0 && contact.normal_impulse == 0) return 0;
  contact.normal_impulse += change;
  Vec3 total = change * contact.normal;
  if (contact.friction > 0) {
    const Vec3 slip = point - contact.rest;
    const Vec3 across = slip - contact.normal.dot(slip) * contact.normal;
    Vec3 friction_impulse = contact.friction_impulse - across / contact.mobility;
    const double most = contact.friction * contact.normal_impulse, wanted = friction_impulse.norm();
    if (wanted > most) friction_impulse *= most / wanted;
    total += friction_impulse - contact.friction_impulse;
    contact.friction_impulse = friction_impulse;
  }
  add_impulse(contact, inverse_mass, total, value);
  return contact.mobility * total.norm();
}

}  // namespace

double mobility_of(const ContactConstraint& contact, const std::vector<double>& inverse_mass) {
  double mobility = 0;
  for (std::size_t k = 0; k < at(contact.count); ++k)
    mobility += contact.weight[k] * contact.weight[k] * inverse_mass[at(contact.particle[k])];
  return mobility;
}

void apply_impulses(const ContactConstraint& contact, const std::vector<double>& inverse_mass,
                    Vec3Field& value) {
  add_impulse(contact, inverse_mass, contact.normal_impulse * contact.normal + contact.friction_impulse,
              value);
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
