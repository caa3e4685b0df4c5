// Contact at the end of a step, and its part of the ledger.
#include "contact/continuous_contact.h"
#include "contact/stiff_contact.h"
#include "measure/energy.h"
#include "scene/method_facts.h"
#include "simulation/simulation.h"

namespace cloth {

void Simulation::resolve_contact(const StepTimes& times) {
  last_contact_ = {};
  if (!contact_->touches(system_, state_)) return end_contact();
  ContactBegin begin{position_before_, velocity_before_, times.step, contact_memory_};
  ConstrainedStep constrained;
  if (stiff_contact_ && !contact_->is_inside(system_, position_before_)) {
    constrained.weight = facts_of(scene_.integrator.method).stage_weight.value_or(1) * times.step;
    constrained.position = state_.position;
    constrained.held = stiff_contact_->solve(system_, *forces_, contact_->obstacles(), constrained.weight,
                                             times.end, position_before_, constrained.position);
    begin.constrained = &constrained;
  }
  last_contact_ = contact_->apply(system_, begin, state_);
  book_contact(times);
}

/// A state that has diverged is not followed: the cloth stays where it was, and the run stops.
void Simulation::resolve_continuous_contact(const StepTimes& times) {
  last_contact_ = {};
  if (is_fast(kinetic_energy(system_, state_.velocity)) && has_run_away()) {
    state_.position = position_before_;
    return;
  }
  const ContactTimes contact_times{times.begin, times.end, times.step};
  if (!continuous_contact_->is_near(position_before_, contact_times, state_)) return end_contact();
  VelocityCoupling coupling{velocity_before_, contact_memory_, {}, {}, {}};
  coupling.potential = [&](const Vec3Field& position) {
    ClothState there;
    there.position = position, there.velocity = Vec3Field(position.size());
    return measure_energy(system_, gravity_of(scene_), there).total();
  };
  const bool follows = integrator_->velocity_follows_positions();
  if (follows)
    coupling.positions = [&](const Vec3Field& motion) {
      integrator_->follow_positions(system_, *forces_, times, motion, state_);
    };
  if (follows && forces_->has_damping())
    coupling.velocities = [&](const Vec3Field& motion) {
      integrator_->follow_velocities(system_, *forces_, times, motion, state_);
    };
  last_contact_ = continuous_contact_->apply(system_, position_before_, contact_times, state_, coupling);
  if (last_contact_.interrupted) return;
  if (!last_contact_.acted) return end_contact();
  book_contact(times);
}

void Simulation::book_contact(const StepTimes& times) {
  ledger_.contact += last_contact_.work;
  contact_impulse_ += last_contact_.impulse;
  ledger_.forces += integrator_->follow_contact(*forces_, times, state_);
}

/// What was lent to impulses of which none came back.
void Simulation::end_contact() {
  ledger_.contact -= contact_memory_.clear();
}

}  // namespace cloth
