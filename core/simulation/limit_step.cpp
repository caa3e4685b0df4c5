// The deformation rate in a step, its part of the ledger, and where it was not kept.
#include <cmath>

#include "measure/energy.h"
#include "simulation/simulation.h"

namespace cloth {

/// For the pins as they stand; they do not move between edits.
void Simulation::make_limiter(const std::vector<double>& tension) {
  unreachable_ = find_unreachable_rate(scene_, system_, run_.state.position);
  limiter_.reset();
  if (!scene_.deformation || !DeformationLimiter::is_needed(*scene_.deformation, system_)) return;
  limiter_.emplace(*scene_.deformation, system_, unreachable_.has_value());
  limiter_->set_tension(tension);
}

/// A start beyond the rate was not reached by any motion, so that bringing it within the rate makes none.
void Simulation::limit_start() {
  if (prepare_ && limiter_) limiter_->limit_initial_shape(run_.time_step, run_.state);
}

bool Simulation::leaves_rate_to_contact() const {
  return limiter_ && contact_ && contact_->solves_rate() && !unreachable_;
}

/// Where the method has not had it done within the step. Returns whether that moved anything.
bool Simulation::limit_deformation() {
  bool moved = false;
  if (!limits_drift_) {
    const bool by_energy = !integrator_->drifts_with_end_velocity();
    const Energy before = by_energy ? energy_of(run_.state) : Energy{};
    if (limiter_->after_step(run_.state)) {
      if (by_energy) {
        const double gained = energy_of(run_.state).potential() - before.potential();
        limiter_->limit_energy_gain(gained, run_.state);
        run_.ledger.limiter += gained + kinetic_energy(system_, run_.state.velocity) - before.kinetic;
      }
      integrator_->forget(Change::state);
      moved = true;
    }
  }
  run_.last_limit = limiter_->report();
  return moved;
}

/// A rate that acts after a method's inner steps may move particles back into obstacles.
void Simulation::limit_between_contacts(const StepTimes& times) {
  const bool follows_contact = inner_contact_ && !limits_drift_;
  if (follows_contact) inner_contact_->begin(run_.state);
  limit_deformation();
  if (follows_contact && inner_contact_->correct(times, run_.state) != InnerStepContact::Outcome::unchanged)
    integrator_->forget(Change::state);
}

/// After contact, which answers the closing kick of held tensions as it does that of any load. It may also
/// have stretched again what was within the rate: what counts is where the step ends.
void Simulation::book_limiter() {
  const bool kept_before_contact = limiter_->is_kept();
  if (limits_drift_) limiter_->end_step(run_.state);
  run_.ledger.limiter += limiter_->work().value_or(0);
  if (run_.last_contact.acted) limiter_->update_excess(run_.state.position);
  run_.last_limit = limiter_->report();
  if (!limiter_->is_kept() && std::isfinite(run_.last_limit.excess)) note_breach(kept_before_contact);
}

void Simulation::note_breach(bool by_contact) {
  if (!run_.rate_breach) {
    const auto [first, second] = limiter_->worst_spring(run_.state.position);
    run_.rate_breach =
        RateBreach{.first_step = run_.state.step + 1,
                   .first_time = run_.first_time +
                                 static_cast<double>(run_.state.step + 1 - run_.first_step) * run_.time_step,
                   .first_particle = first,
                   .second_particle = second,
                   .first_excess = run_.last_limit.excess,
                   .unreachable = unreachable_.has_value(),
                   .by_contact = by_contact,
                   .columns = system_.is_mesh() ? 0 : system_.columns};
  }
  ++run_.rate_breach->steps;
  if (!(run_.last_limit.excess > run_.rate_breach->largest_excess)) return;
  run_.rate_breach->largest_excess = run_.last_limit.excess;
  run_.rate_breach->largest_step = run_.state.step + 1;
}

}  // namespace cloth
