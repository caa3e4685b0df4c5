// The deformation rate in a step, its part of the ledger, and where it was not kept.
#include <cmath>

#include "measure/energy.h"
#include "simulation/simulation.h"

namespace cloth {

/// Only of pins, which do not move between edits.
void Simulation::find_unreachable() {
  unreachable_ = find_unreachable_rate(scene_, system_, state_.position);
  if (limiter_) limiter_->set_unreachable(unreachable_.has_value());
}

/// A start beyond the rate was not reached by any motion, so that bringing it within the rate makes none.
void Simulation::limit_start() {
  if (prepare_ && limiter_) limiter_->limit_initial_shape(time_step_, state_);
}

/// Where the method has not had it done within the step.
void Simulation::limit_deformation() {
  if (!limits_drift_) {
    const bool by_energy = !integrator_->drifts_with_end_velocity();
    const Vec3 gravity = gravity_of(scene_);
    const Energy before = by_energy ? measure_energy(system_, gravity, state_) : Energy{};
    if (limiter_->after_step(state_)) {
      if (by_energy) {
        const double gained = measure_energy(system_, gravity, state_).potential() - before.potential();
        limiter_->limit_energy_gain(gained, state_);
        ledger_.limiter += gained + kinetic_energy(system_, state_.velocity) - before.kinetic;
      }
      integrator_->forget(Change::state);
    }
  }
  last_limit_ = limiter_->report();
}

/// After contact, which answers the closing kick of held tensions as it does that of any load. It may also
/// have stretched again what was within the rate: what counts is where the step ends.
void Simulation::book_limiter() {
  const bool kept_before_contact = limiter_->is_kept();
  if (limits_drift_) limiter_->end_step(state_);
  ledger_.limiter += limiter_->work().value_or(0);
  if (last_contact_.acted) limiter_->update_excess(state_.position);
  last_limit_ = limiter_->report();
  if (!limiter_->is_kept() && std::isfinite(last_limit_.excess)) note_breach(kept_before_contact);
}

void Simulation::note_breach(bool by_contact) {
  if (!rate_breach_) {
    const auto [first, second] = limiter_->worst_spring(state_.position);
    rate_breach_ = RateBreach{
        .first_step = state_.step + 1,
        .first_time = first_time_ + static_cast<double>(state_.step + 1 - first_step_) * time_step_,
        .first_particle = first,
        .second_particle = second,
        .first_excess = last_limit_.excess,
        .unreachable = unreachable_.has_value(),
        .by_contact = by_contact,
        .columns = system_.is_mesh() ? 0 : system_.columns};
  }
  ++rate_breach_->steps;
  if (!(last_limit_.excess > rate_breach_->largest_excess)) return;
  rate_breach_->largest_excess = last_limit_.excess;
  rate_breach_->largest_step = state_.step + 1;
}

}  // namespace cloth
