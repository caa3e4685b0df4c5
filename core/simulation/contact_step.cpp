// Contact at the end of a step, and its part of the ledger.
#include "measure/energy.h"
#include "simulation/simulation.h"

namespace cloth {

/// Continuous contact does not follow what has diverged: it stays where it was, and the run stops.
std::optional<ContactReport> Simulation::contact_of(const StepTimes& times, const Vec3Field& position_before,
                                                    const Vec3Field& velocity_before) {
  if (contact_->is_continuous() && is_fast(kinetic_energy(system_, run_.state.velocity)) && has_diverged())
    return std::nullopt;
  const auto potential = [this, there = ClothState{}](const Vec3Field& position) mutable {
    if (there.velocity.size() != position.size()) there.velocity = Vec3Field(position.size());
    there.position = position;
    return energy_of(there).total();
  };
  std::function<bool()> limit;
  if (leaves_rate_to_contact()) limit = [this] { return limit_deformation(); };
  return contact_->resolve({system_, *forces_, *integrator_, times, position_before, velocity_before,
                            run_.contact_memory, potential, limit},
                           run_.state);
}

void Simulation::resolve_contact(const StepTimes& times) {
  run_.last_contact = {};
  if (inner_contact_) {
    run_.last_contact = inner_contact_->take_report();
  } else if (const auto found = contact_of(times, position_before_, velocity_before_)) {
    run_.last_contact = *found;
  } else {
    run_.state.position = position_before_;
    return;
  }
  if (run_.last_contact.interrupted) return;
  if (run_.last_contact.acted) return book_contact(times);
  end_contact();
}

void Simulation::book_contact(const StepTimes& times) {
  if (!inner_contact_) run_.ledger.contact += run_.last_contact.work;
  run_.ledger.limiter += run_.last_contact.rate_work;
  run_.contact_impulse += run_.last_contact.impulse;
  if (inner_contact_) return;
  const auto& found = run_.last_contact.force_work;
  run_.ledger.forces += found ? *found : integrator_->correct_work(*forces_, times, run_.state);
}

/// What was lent to impulses of which none came back.
void Simulation::end_contact() {
  run_.ledger.contact -= run_.contact_memory.clear();
}

}  // namespace cloth
