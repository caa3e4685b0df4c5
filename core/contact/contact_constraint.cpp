#include "contact/contact_constraint.h"

namespace cloth {

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
