#include "integrators/verlet.h"

#include "cloth/sums.h"

namespace cloth {
namespace {

constexpr VelocityUpdate once[] = {{1, 1}}, twice[] = {{1, 0}, {1, 1}},
                         three_times[] = {{0.5, 0}, {1, 0.5}, {1, 1}};

/// Of the velocities from which those after contact follow by one more evaluation of the damping
/// (update_velocity_for_damping()): what contact changes there is larger by orders.
constexpr double tolerance_before_contact = 1e-5;

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
  if (!holds_force_) evaluate(forces, state);
  work += 0.5 * h * power_;
  if (constraint_) constraint_->before_kick(0.5 * h, h, state);
  add_acceleration(forces.system(), 0.5 * h, force(forces), state.velocity);
  add_scaled(h, state.velocity, state.position);
  if (keeps && end_ == EndVelocity::predicted)
    add_acceleration(forces.system(), 0.5 * h, force_, state.velocity);
  if (constraint_) constraint_->after_drift(0.5 * h, state);
  if (corrects) correct_opening(forces, 0.5 * h, work);
  holds_position_force_ = led_by_contact_ = false;
  is_open_ = true;
  return report;
}

void Verlet::close_step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work,
                        IntegratorReport& report) {
  const double h = times.step;
  forces.update(state.position, times.end);
  if (keeps_force(forces))
    finish_unsolved(forces, 0.5 * h, state);
  else
    report.velocity_iterations = finish_velocity(forces, 0.5 * h, solved_tolerance, state);
  if (!holds_force_) evaluate(forces, state);
  work += 0.5 * h * power_;
  work.damping_loss += closing_correction_ = closing_correction(forces, h);
  holds_position_force_ = true;
  is_open_ = false;
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
  if (constraint_) constraint_->close(state);
  forces.update(state.position, times.end);
  if (forces.has_damping()) forces.force(state.position, state.velocity, force_);
  led_by_contact_ = true;
  return finish_velocity(forces, 0.5 * times.step, tolerance_before_contact, state);
}

/// Without it the cloth beside a contact would be damped by the speed that it would have had without contact,
/// and at rest keep a speed of some h^2 g times damping over mass.
void Verlet::update_velocity_for_damping(ForceModel& forces, const StepTimes& times,
                                         const Vec3Field& half_velocity, ClothState& state) {
  if (forces.has_damping()) forces.force(state.position, state.velocity, force_);
  holds_force_ = false;
  state.velocity = half_velocity;
  if (constraint_) constraint_->close(state);
  add_acceleration(forces.system(), 0.5 * times.step, force(forces), state.velocity);
}

/// Its damping stays as it is.
Vec3Field* Verlet::held_force() {
  if (end_ != EndVelocity::solved && holds_force_) {
    holds_position_force_ = false;
    return &force_;
  }
  forget(Change::forces);
  return nullptr;
}

IntegratorMemory Verlet::remember() const {
  if (end_ == EndVelocity::solved || !holds_force_) return {};
  return {.fields = {force_},
          .numbers = {power_.damping_loss, power_.hysteresis_loss, power_.air, power_.brush, power_.pull,
                      closing_correction_}};
}

void Verlet::recall(const IntegratorMemory& memory) {
  forget(Change::state);
  if (end_ == EndVelocity::solved || memory.fields.empty()) return;
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
  Work correction;
  if (!was_open) correction = -0.5 * times.step * power_;
  evaluate(forces, state);
  correction += 0.5 * times.step * power_;
  correction.damping_loss -= closing_correction_;
  correction.damping_loss += closing_correction_ = closing_correction(forces, times.step);
  return correction;
}

}  // namespace cloth
