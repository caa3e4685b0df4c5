#include "integrators/verlet.h"

#include "cloth/sums.h"

namespace cloth {
namespace {

constexpr VelocityUpdate once[] = {{1, 1}}, twice[] = {{1, 0}, {1, 1}},
                         three_times[] = {{0.5, 0}, {1, 0.5}, {1, 1}};

/// Of the velocities from which those after contact follow (update_velocity_for_damping()), and of those at
/// which it is damped: what contact changes there is larger by orders.
constexpr double tolerance_of_contact = 1e-5;

}  // namespace

std::span<const VelocityUpdate> evaluations_of(EndVelocity end) {
  switch (end) {
    case EndVelocity::predicted:
      return once;
    case EndVelocity::corrected:
      return twice;
    case EndVelocity::corrected_twice:
      return three_times;
    case EndVelocity::solved:
      break;
  }
  return {};
}

double power_beside(const Vec3Field& position_force, const Vec3Field& force, const SparseField& change) {
  if (!change.is_everywhere()) {
    double power = 0;
    for (const std::uint32_t i : change.particles()) power += (force[i] - position_force[i]).dot(change[i]);
    return power;
  }
  const double *all = force.flat().data(), *rest = position_force.flat().data();
  return ordered_sum(3 * force.size(), [all, rest, by = change.values().flat().data()](std::size_t k) {
    return (all[k] - rest[k]) * by[k];
  });
}

IntegratorReport Verlet::step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) {
  IntegratorReport report = open_step(forces, times, state, work);
  close_step(forces, times, state, work, report);
  return report;
}

bool Verlet::keeps_force(const ForceModel& forces) const {
  return end_ != EndVelocity::solved && forces.has_damping();
}

/// A constraint ties the closing kick to the drift.
bool Verlet::waits_for_contact(const ForceModel& forces) const {
  return !constraint_ && !(end_ == EndVelocity::predicted && forces.has_damping());
}

IntegratorReport Verlet::open_step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                   Work& work) {
  IntegratorReport report{.force_evaluations = 1};  // of the closing
  const double h = times.step;
  const bool keeps = keeps_force(forces), corrects = constraint_ && forces.has_damping_loss();
  if (!holds_position_force_ && (!keeps || corrects || !holds_force_))
    forces.update(state.position, times.begin);
  if (keeps ? !holds_force_ : !holds_position_force_) ++report.force_evaluations;
  const bool as_closed = holds_force_ && holds_position_force_ && !holds_damped_;
  if (!holds_force_) evaluate(forces, state);
  open_kicks(forces, h, as_closed, state);
  work += 0.5 * h * power_;
  if (constraint_) constraint_->before_kick(0.5 * h, h, state);
  add_acceleration(forces.system(), 0.5 * h, force(forces), state.velocity);
  add_scaled(h, state.velocity, state.position);
  if (keeps && end_ == EndVelocity::predicted)
    add_acceleration(forces.system(), 0.5 * h, force_, state.velocity);
  if (constraint_) constraint_->after_drift(0.5 * h, state);
  if (corrects && !kicks_.is_known()) correct_opening(forces, 0.5 * h, work);
  holds_position_force_ = led_by_contact_ = holds_damped_ = false;
  is_open_ = true;
  return report;
}

void Verlet::close_step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work,
                        IntegratorReport& report) {
  const double h = times.step;
  // The constraint has added its part of the closing kick already.
  if (kicks_.is_known()) kicks_.drift(state.velocity, constraint_ ? constraint_->closing_change() : nullptr);
  forces.update(state.position, times.end);
  if (keeps_force(forces))
    finish_unsolved(forces, 0.5 * h, state);
  else
    report.velocity_iterations = finish_velocity(forces, 0.5 * h, solved_tolerance, state);
  if (!holds_force_) evaluate(forces, state);
  work += 0.5 * h * power_;
  close_kicks(forces, state);
  closing_correction_ =
      kicks_.is_known() ? -kicks_.beside_trapezoid(forces.system()) : closing_correction(forces, h);
  work.damping_loss += closing_correction_;
  holds_position_force_ = true;
  is_open_ = false;
}

/// Only where damping that couples particles is solved for. Otherwise h D is less than twice m, or what
/// contact stops is not damped, and the powers are near enough.
void Verlet::open_kicks(const ForceModel& forces, double step, bool as_closed, const ClothState& state) {
  if (end_ != EndVelocity::solved || !forces.has_damping_loss() || !forces.couples_particles())
    kicks_.forget();
  else if (as_closed && kicks_.is_closed())
    kicks_.open_as_closed(step);
  else
    kicks_.open(step, holds_damped_ ? damped_ : state.velocity, force_, forces.position_force());
}

void Verlet::close_kicks(const ForceModel& forces, const ClothState& state) {
  if (!kicks_.is_known()) return;
  kicks_.close(state.velocity, force_, forces.position_force());
  integrated_ = state.position;
  closing_power_ = power_;
}

/// What is to be added where contact has changed the state. `was_led`: contact has had the velocities of
/// update_velocity_for_damping(), and books what its impulses do beside those kicks.
Work Verlet::correct_kicks(const ForceModel& forces, double half_step, bool was_open, bool was_led,
                           const ClothState& state) {
  const double booked = was_open ? 0 : closing_correction_;
  Work correction;
  if (was_led) {
    correction = half_step * power_;
    if (!was_open) correction += -half_step * closing_power_;
    closing_correction_ = -kicks_.beside_trapezoid(forces.system());
  } else {
    closing_correction_ =
        -kicks_.beside_trapezoid(forces.system(), integrated_, state, forces.position_force());
    damp_change(forces, half_step, kicks_.end_velocity(), state);
  }
  correction.damping_loss += closing_correction_ - booked;
  holds_force_ = holds_damped_ = true;
  return correction;
}

/// The damping at the velocity to which the closing kick leads with contact's change of `unchanged` in it.
void Verlet::damp_change(const ForceModel& forces, double half_step, const Vec3Field& unchanged,
                         const ClothState& state) {
  damped_ = kicks_.drift_velocity();
  const SparseField* closing = constraint_ ? constraint_->closing_change() : nullptr;
  if (closing) add_scaled(1, *closing, damped_);
  add_scaled(1, state.velocity, damped_);
  add_scaled(-1, unchanged, damped_);
  solver_.solve(forces, half_step, tolerance_of_contact, state.position, damped_, force_);
  power_ = forces.force_and_power(state.position, damped_, force_);
}

/// From the velocity of the first evaluation.
void Verlet::finish_unsolved(ForceModel& forces, double half_step, ClothState& state) {
  const std::span<const VelocityUpdate> evaluations = evaluations_of(end_);
  Vec3Field& change = scratch_;
  for (std::size_t k = 0; k < evaluations.size(); ++k) {
    change = force_;
    if (k + 1 < evaluations.size())
      forces.force(state.position, state.velocity, force_);
    else
      power_ = forces.force_and_power(state.position, state.velocity, force_);
    const auto from = change.flat();
    const std::span<const double> to = force_.flat();
    for (std::size_t i = 0; i < from.size(); ++i)
      from[i] = evaluations[k].gain * to[i] - evaluations[k].held * from[i];
    add_acceleration(forces.system(), half_step, change, state.velocity);
  }
  holds_force_ = true;
}

/// The damping is still that of the opening kick.
void Verlet::correct_opening(const ForceModel& forces, double half_step, Work& work) const {
  if (const SparseField* change = constraint_->opening_change())
    work.damping_loss -= half_step * power_beside(forces.position_force(), force_, *change);
}

/// Damping works with the velocity at the ends of a step, but without what a constraint's kicks, counted
/// before and after all others, change there: held tensions and the springs that they answer cancel in the
/// next kick, and nothing has gone so fast.
double Verlet::closing_correction(const ForceModel& forces, double step) {
  if (!constraint_ || !forces.has_damping_loss() || !constraint_->closing_change()) return 0;
  return 0.5 * step * power_beside(forces.position_force(), force_, *constraint_->closing_change());
}

void Verlet::evaluate(ForceModel& forces, const ClothState& state) {
  if (forces.has_damping())
    power_ = forces.force_and_power(state.position, state.velocity, force_);
  else if (forces.has_power())
    power_ = forces.power(state.position, state.velocity);
  holds_force_ = true;
}

/// Where nothing damps it is known without being kept.
const Vec3Field& Verlet::force(const ForceModel& forces) const {
  return forces.has_damping() ? force_ : forces.position_force();
}

/// From the velocity at half the step. `force_` is the guess, or that at this velocity; what it leads to is
/// evaluated once more by update_velocity_for_damping(). Returns the iterations.
int Verlet::finish_velocity(ForceModel& forces, double half_step, double tolerance, ClothState& state) {
  holds_force_ = false;
  if (!keeps_force(forces)) {
    if (forces.has_damping())
      return solver_.solve(forces, half_step, tolerance, state.position, state.velocity, force_);
    add_acceleration(forces.system(), half_step, forces.position_force(), state.velocity);
    return 0;
  }
  if (end_ == EndVelocity::corrected_twice) {
    Vec3Field& ahead = scratch_;
    ahead = state.velocity;
    add_acceleration(forces.system(), evaluations_of(end_)[0].gain * half_step, force_, ahead);
    forces.force(state.position, ahead, force_);
  }
  add_acceleration(forces.system(), half_step, force_, state.velocity);
  return 0;
}

/// Without it the cloth beside a contact would feel springs at positions that contact has undone, and at rest
/// keep a speed of some omega^2 h^3 g that no position follows.
int Verlet::update_velocity_for_positions(ForceModel& forces, const StepTimes& times,
                                          const Vec3Field& half_velocity, ClothState& state) {
  state.velocity = half_velocity;
  if (kicks_.is_known()) kicks_.drift(half_velocity);
  if (constraint_) constraint_->close(state);
  forces.update(state.position, times.end);
  if (forces.has_damping()) forces.force(state.position, state.velocity, force_);
  led_by_contact_ = true;
  const int iterations = finish_velocity(forces, 0.5 * times.step, tolerance_of_contact, state);
  if (kicks_.is_known()) free_velocity_ = state.velocity;
  return iterations;
}

/// Without it the cloth beside a contact would be damped by the speed that it would have had without contact,
/// and at rest keep a speed of some h^2 g times damping over mass.
void Verlet::update_velocity_for_damping(ForceModel& forces, const StepTimes& times,
                                         const Vec3Field& half_velocity, ClothState& state) {
  if (kicks_.is_known()) {
    damp_change(forces, 0.5 * times.step, free_velocity_, state);
    kicks_.close(damped_, force_, forces.position_force());
  } else if (forces.has_damping()) {
    forces.force(state.position, state.velocity, force_);
  }
  holds_force_ = false;
  state.velocity = half_velocity;
  if (constraint_) constraint_->close(state);
  add_acceleration(forces.system(), 0.5 * times.step, force(forces), state.velocity);
}

/// Its damping stays as it is.
Vec3Field* Verlet::held_force() {
  if ((end_ != EndVelocity::solved || holds_damped_) && holds_force_) {
    holds_position_force_ = false;
    return &force_;
  }
  forget(Change::forces);
  return nullptr;
}

IntegratorMemory Verlet::remember() const {
  if (!holds_force_ || (end_ == EndVelocity::solved && !holds_damped_)) return {};
  IntegratorMemory memory{.fields = {force_},
                          .numbers = {power_.damping_loss, power_.hysteresis_loss, power_.air, power_.brush,
                                      power_.pull, closing_correction_}};
  if (holds_damped_) memory.fields.push_back(damped_);
  return memory;
}

void Verlet::recall(const IntegratorMemory& memory) {
  forget(Change::state);
  if (memory.fields.empty()) return;
  holds_damped_ = memory.fields.size() > 1;
  if (holds_damped_) damped_ = memory.fields[1];
  force_ = memory.fields[0];
  const std::vector<double>& n = memory.numbers;
  power_ = {n[0], n[1], n[2], n[3], n[4]};
  closing_correction_ = n[5];
  holds_force_ = true;
}

/// The next step would begin with this evaluation.
Work Verlet::correct_work(ForceModel& forces, const StepTimes& times, const ClothState& state) {
  const bool was_open = is_open_, is_updated = led_by_contact_;
  forget(Change::state);
  if (!is_updated && forces.has_power()) forces.update(state.position, times.end);
  holds_position_force_ = is_updated || forces.has_power();
  if (!forces.has_power()) return {};
  if (kicks_.is_closed()) return correct_kicks(forces, 0.5 * times.step, was_open, is_updated, state);
  Work correction;
  if (!was_open) correction = -0.5 * times.step * power_;
  evaluate(forces, state);
  correction += 0.5 * times.step * power_;
  correction.damping_loss -= closing_correction_;
  correction.damping_loss += closing_correction_ = closing_correction(forces, times.step);
  return correction;
}

}  // namespace cloth
