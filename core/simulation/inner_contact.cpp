#include "simulation/inner_contact.h"

#include <algorithm>
#include <utility>

namespace cloth {

void InnerContact::begin(const ClothState& state) {
  position_ = state.position;
  velocity_ = state.velocity;
}

InnerStepContact::Outcome InnerContact::correct(const StepTimes& times, ClothState& state) {
  const std::optional<ContactReport> found = resolve_(times, position_, velocity_);
  if (!found) {
    state.position = position_;
    return Outcome::ended;
  }
  report_.rounds += found->rounds;
  report_.interrupted = found->interrupted;
  if (found->interrupted) return Outcome::ended;
  report_.pinch = found->pinch, report_.exhausted = found->exhausted;
  const bool ends = found->pinch || found->exhausted;
  if (!found->acted) return ends ? Outcome::ended : Outcome::unchanged;
  report_.acted = true;
  report_.contacts = found->contacts, report_.pairs = found->pairs;
  report_.held_back = std::max(report_.held_back, found->held_back);
  report_.work += found->work, report_.impulse += found->impulse;
  return ends ? Outcome::ended : Outcome::changed;
}

ContactReport InnerContact::take_report() {
  return std::exchange(report_, {});
}

}  // namespace cloth
