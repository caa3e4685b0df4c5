#include "contact/inner_contact.h"

namespace cloth {

void InnerContact::begin(const ClothState& state) {
  position_ = state.position;
  velocity_ = state.velocity;
}

bool InnerContact::correct(double step, ClothState& state) {
  const ContactReport report = contact_.apply(system_, {position_, velocity_, step, memory_}, state);
  if (!report.acted) return false;
  report_.acted = true;
  report_.contacts = report.contacts;
  report_.work += report.work;
  return true;
}

}  // namespace cloth
