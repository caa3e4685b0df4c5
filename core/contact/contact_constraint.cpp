#include "contact/contact_constraint.h"

namespace cloth {

void add_impulse(const ContactConstraint& contact, const std::vector<double>& inverse_mass,
                 const Vec3& impulse, Vec3Field& value) {
  for (std::size_t k = 0; k < at(contact.count); ++k) {
    const auto i = at(contact.particle[k]);
    value.add(i, contact.weight[k] * inverse_mass[i] * impulse);
  }
}

double mobility_of(const ContactConstraint& contact, const std::vector<double>& inverse_mass) {
  double mobility = 0;
  for (std::size_t k = 0; k < at(contact.count); ++k)
    mobility += contact.weight[k] * contact.weight[k] * inverse_mass[at(contact.particle[k])];
  return mobility;
}

void apply_impulses(const ContactConstraint& contact, const std::vector<double>& inverse_mass,
                    Vec3Field& value) {
  if (contact.normal_impulse == 0 && contact.friction_impulse.isZero(0)) return;
  add_impulse(contact, inverse_mass, contact.normal_impulse * contact.normal + contact.friction_impulse,
              value);
}

}  // namespace cloth
