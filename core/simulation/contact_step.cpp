// Contact at the end of a step, and its part of the ledger.
#include "measure/energy.h"
#include "scene/method_facts.h"
#include "simulation/simulation.h"

namespace cloth {

/// Continuous contact does not follow what has diverged: it stays where it was, and the run stops.
void Simulation::resolve_contact(const StepTimes& times) {
  run_.last_contact = {};
  if (meets_contact_within_steps_) {
    run_.last_contact = contact_->take_inner_report();
    run_.ledger.contact += run_.last_contact.work;
    return;
  }
  if (contact_->is_continuous() && is_fast(kinetic_energy(system_, run_.state.velocity)) && has_diverged()) {
    run_.state.position = position_before_;
    return;
  }
  const auto potential = [&](const Vec3Field& position) {
    ClothState there;
    there.position = position, there.velocity = Vec3Field(position.size());
    return energy_of(there).total();
  };
  const double stage_weight = facts_of(scene_.integrator.method).stage_weight.value_or(1);
  run_.last_contact = contact_->resolve({system_, *forces_, *integrator_, times, stage_weight,
                                         position_before_, velocity_before_, run_.contact_memory, potential},
                                        run_.state);
  if (run_.last_contact.interrupted) return;
  if (!run_.last_contact.acted) return end_contact();
  book_contact(times);
}

void Simulation::book_contact(const StepTimes& times) {
  run_.ledger.contact += run_.last_contact.work;
  run_.contact_impulse += run_.last_contact.impulse;
  run_.ledger.forces += integrator_->correct_work(*forces_, times, run_.state);
}

/// What was lent to impulses of which none came back.
void Simulation::end_contact() {
  run_.ledger.contact -= run_.contact_memory.clear();
}

}  // namespace cloth
