#include "integrators/fused_steppers.h"

#include "forces/air.h"
#include "forces/damping_at.h"

namespace cloth {
namespace {

/// What acts beside the elasticity of springs in a step whose forces are taken at `times`, in s.
SweepLoads loads_at(const ForceModel& forces, std::span<const double> times) {
  const SweepTerms& swept = forces.swept();
  SweepLoads loads{.weight = forces.weight(),
                   .damping = swept.damping,
                   .spring_damping = swept.spring_damping,
                   .stretch_time = swept.stretch_time,
                   .bending_time = swept.bending_time,
                   .sliders = swept.sliders};
  if (swept.air) {
    loads.air.drag = swept.air_drag, loads.air.friction = swept.air_friction;
    for (std::size_t k = 0; k < times.size(); ++k) loads.air.wind[k] = wind_at(*swept.air, times[k]);
  }
  return loads;
}

}  // namespace

IntegratorReport FusedStepper::step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                    Work& work) {
  double squares = 0;
  sweep(forces, times, {&squares, 1}, state, work);
  return {.force_evaluations = evaluations_, .speed_squares = squares};
}

IntegratorReport FusedStepper::step_many(ForceModel& forces, double step, std::span<double> speed_squares,
                                         ClothState& state, Work& work) {
  sweep(forces, {0, 0, step}, speed_squares, state, work);  // at any time: no force changes with it
  return {.force_evaluations = evaluations_, .speed_squares = speed_squares.back()};
}

/// The steps of a batch take all forces at one time, and no end of a step lies between them.
bool FusedStepper::gains_from_batches(const ForceModel& forces) const {
  const Air* air = forces.swept().air;
  return forces.is_swept_whole() && !forces.has_history() && !(air && air->gust) &&
         forces.sweep()->gains_steps_at_once();
}

void FusedEuler::sweep(ForceModel& forces, const StepTimes& times, std::span<double> speed_squares,
                       ClothState& state, Work& work) {
  SweepLoads loads = loads_at(forces, {&times.begin, 1});
  Work power_of_load;
  if (forces.has_step_load()) {
    power_of_load = forces.step_load(state.position, state.velocity, times.begin, load_);
    loads.load = &load_;
  }
  sums_.assign(speed_squares.size(), {});
  forces.sweep()->euler(times.step, drift_first_, loads, sums_, state);
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    speed_squares[k] = sums_[k].after;
    Work power = power_of_load;
    power +=
        {.damping_loss = forces.swept().damping * sums_[k].before + sums_[k].dampers, .air = sums_[k].air};
    if (forces.has_power()) work += times.step * power;
  }
}

IntegratorReport FusedSemiImplicitEuler::step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                              Work& work) {
  if (constraint_ && constraint_->holds()) return held_step(forces, times, state, work);
  if (constraint_) constraint_->before_kick(times.step, times.step, state);
  IntegratorReport report = FusedEuler::step(forces, times, state, work);
  if (!constraint_) return report;
  constraint_->after_drift(0, state);
  if (constraint_->opening_change()) report.speed_squares.reset();
  return report;
}

/// The forces are those at the velocity before the constraint's kick, which is therefore added after the
/// pass.
IntegratorReport FusedSemiImplicitEuler::held_step(ForceModel& forces, const StepTimes& times,
                                                   ClothState& state, Work& work) {
  before_ = state.velocity;
  constraint_->before_kick(times.step, times.step, state);
  std::swap(before_, state.velocity);
  Vec3Field& kick = before_;
  add_scaled(-1, state.velocity, kick);
  IntegratorReport report = FusedEuler::step(forces, times, state, work);
  add_scaled(1, kick, state.velocity);
  add_scaled(times.step, kick, state.position);
  constraint_->after_drift(0, state);
  report.speed_squares.reset();
  return report;
}

bool FusedVerlet::suits(const ForceModel& forces, bool constrained) {
  return forces.is_swept_whole() && !constrained && !forces.swept().air && !forces.swept().has_dampers();
}

void FusedVerlet::evaluate(ForceModel& forces, const ClothState& state) {
  if (forces.has_power())
    power_ = Work{.damping_loss = forces.swept().damping * forces.sweep()->squares(state.velocity)};
}

IntegratorReport FusedVerlet::step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                   Work& work) {
  IntegratorReport report{.force_evaluations = 1};
  if (!holds_position_force_) {
    forces.update(state.position, times.begin);
    evaluate(forces, state);
    ++report.force_evaluations;
  }
  work += 0.5 * times.step * power_;
  const double squares =
      forces.sweep()->verlet(times.step, loads_at(forces, {}), forces.position_force_to_advance(), state);
  power_ = Work{.damping_loss = forces.swept().damping * squares};
  work += 0.5 * times.step * power_;
  report.speed_squares = squares;
  holds_position_force_ = true;
  return report;
}

/// The velocity at the end of a step and at the half of the next are made in one pass, so that the force need
/// not be stored: a third less memory traffic.
IntegratorReport FusedVerlet::step_many(ForceModel& forces, double step, std::span<double> speed_squares,
                                        ClothState& state, Work& work) {
  forces.sweep()->verlet_steps(step, loads_at(forces, {}), speed_squares, forces.position_force_to_advance(),
                               state);
  if (forces.has_power())
    for (const double squares : speed_squares) {
      work += 0.5 * step * power_;
      power_ = Work{.damping_loss = forces.swept().damping * squares};
      work += 0.5 * step * power_;
    }
  return {.force_evaluations = 1, .speed_squares = speed_squares.back()};
}

Work FusedDampedVerlet::power_of(const ForceModel& forces, const StepSums& sums) const {
  return {.damping_loss = forces.swept().damping * sums.before + sums.dampers, .air = sums.air};
}

/// Unless it is held: the force at the state, at no other velocity.
int FusedDampedVerlet::begin_force(ForceModel& forces, double time, ClothState& state) {
  if (holds_force_) return 0;
  if (force_.size() != state.position.size()) force_ = Vec3Field(state.position.size());
  force_.fill(0);
  const SweepLoads loads = loads_at(forces, {&time, 1});
  power_ = power_of(forces, forces.sweep()->predicted_close(0, {}, loads, force_, state));
  holds_force_ = true;
  return 1;
}

IntegratorReport FusedDampedVerlet::step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                         Work& work) {
  if (constraint_) return constrained_step(forces, times, state, work);
  IntegratorReport report{.force_evaluations = 1 + begin_force(forces, times.begin, state)};
  const SweepLoads loads = loads_at(forces, {&times.end, 1});
  work += 0.5 * times.step * power_;
  StepSums sums = forces.sweep()->predicted(times.step, evaluations_[0], loads, force_, state);
  for (const VelocityUpdate& update : evaluations_.subspan(1))
    sums = forces.sweep()->predicted_close(times.step, update, loads, force_, state);
  finish(forces, 0.5 * times.step, sums, work, report);
  return report;
}

IntegratorReport FusedDampedVerlet::open_step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                              Work& work) {
  IntegratorReport report{.force_evaluations = 1 + begin_force(forces, times.begin, state)};
  work += 0.5 * times.step * power_;
  forces.sweep()->predicted_open(times.step, evaluations_[0], loads_at(forces, {}), force_, state);
  holds_position_force_ = led_by_contact_ = false;
  is_open_ = true;
  return report;
}

void FusedDampedVerlet::close_step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work,
                                   IntegratorReport& report) {
  const SweepLoads loads = loads_at(forces, {&times.end, 1});
  StepSums sums;
  for (const VelocityUpdate& update : evaluations_)
    sums = forces.sweep()->predicted_close(times.step, update, loads, force_, state);
  finish(forces, 0.5 * times.step, sums, work, report);
}

void FusedDampedVerlet::finish(const ForceModel& forces, double half_step, const StepSums& sums, Work& work,
                               IntegratorReport& report) {
  power_ = power_of(forces, sums);
  work += half_step * power_;
  report.speed_squares = sums.after;
  holds_position_force_ = is_open_ = false, holds_force_ = true;
}

IntegratorReport FusedDampedVerlet::constrained_step(ForceModel& forces, const StepTimes& times,
                                                     ClothState& state, Work& work) {
  const bool knows_damping = DampingAt::suits(forces.system(), forces.swept());
  if (constraint_->holds() && !(knows_damping && constraint_->holds_few())) {
    IntegratorReport report = Verlet::open_step(forces, times, state, work);
    Verlet::close_step(forces, times, state, work, report);
    return report;
  }
  IntegratorReport report{.force_evaluations = 1 + begin_force(forces, times.begin, state)};
  const double half = 0.5 * times.step;
  const SweepLoads loads = loads_at(forces, {&times.end, 1});
  open_constrained(forces, times, loads, state);
  work += half * power_;
  closing_correction_ = 0;
  const SparseField* opening = constraint_->opening_change();
  const bool corrects = opening && forces.has_damping_loss();
  const bool is_few = !opening || (knows_damping && DampingAt::is_worthwhile(*opening));
  if (corrects) work.damping_loss -= half * power_at_opening(forces, times, is_few, state);
  if (!is_few) {
    Verlet::close_step(forces, times, state, work, report);
    return report;
  }
  StepSums sums;
  for (const VelocityUpdate& update : evaluations_) {
    const SparseField* closing = corrects ? constraint_->closing_change() : nullptr;
    if (closing && &update == &evaluations_.back())
      closing_correction_ =
          half * DampingAt(forces.system(), forces.swept()).power(state.position, state.velocity, *closing);
    sums = forces.sweep()->predicted_close(times.step, update, loads, force_, state);
  }
  finish(forces, half, sums, work, report);
  work.damping_loss += closing_correction_;
  return report;
}

/// Up to where the positions are known. Only a step that begins with tensions, which nearly always moves
/// particles, keeps its beginning.
void FusedDampedVerlet::open_constrained(ForceModel& forces, const StepTimes& times, const SweepLoads& loads,
                                         ClothState& state) {
  keeps_before_ = constraint_->holds();
  if (keeps_before_) before_.position = state.position, before_.velocity = state.velocity;
  constraint_->before_kick(0.5 * times.step, times.step, state);
  forces.sweep()->predicted_open(times.step, evaluations_[0], loads, force_, state);
  constraint_->after_drift(0.5 * times.step, state);
}

/// The power of -D v for the constraint's change in the opening of the step, with the velocity that the step
/// began with instead of the one at which its damping was evaluated: no pass keeps the damping apart from
/// other forces, and in the ledger the difference is one of order 2.
double FusedDampedVerlet::power_at_opening(ForceModel& forces, const StepTimes& times, bool is_few,
                                           const ClothState& state) {
  if (!keeps_before_) find_before(forces, times.step, state);
  const SparseField& change = *constraint_->opening_change();
  if (is_few)
    return DampingAt(forces.system(), forces.swept()).power(before_.position, before_.velocity, change);
  if (scratch_.size() != state.position.size()) scratch_ = Vec3Field(state.position.size());
  forces.update(before_.position, times.begin);
  forces.force(before_.position, before_.velocity, scratch_);
  return power_beside(forces.position_force(), scratch_, change);
}

/// The state at the beginning of the step, to rounding, from the drifted one and what the constraint has
/// changed of it.
void FusedDampedVerlet::find_before(const ForceModel& forces, double step, const ClothState& state) {
  const SparseField& change = *constraint_->opening_change();
  before_.position = state.position, before_.velocity = state.velocity;
  add_scaled(-1, change, before_.velocity);
  if (const SparseField* closing = constraint_->closing_change()) add_scaled(-1, *closing, before_.velocity);
  add_acceleration(forces.system(), -0.5 * step * evaluations_[0].held, force_, before_.velocity);
  add_scaled(-step, change, before_.position);
  add_scaled(-step, before_.velocity, before_.position);
  add_acceleration(forces.system(), -0.5 * step, force_, before_.velocity);
}

/// The next step begins with this evaluation.
Work FusedDampedVerlet::correct_work(ForceModel& forces, const StepTimes& times, const ClothState& state) {
  if (is_open_ || led_by_contact_ || (constraint_ && constraint_->closing_change()))
    return Verlet::correct_work(forces, times, state);
  Work correction = -0.5 * times.step * power_;
  forget(Change::state);
  begin_force(forces, times.end, const_cast<ClothState&>(state));  // with no step it is only read
  correction += 0.5 * times.step * power_;
  return correction;
}

IntegratorReport FusedRk4::step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) {
  if (general_.follows_contact() && forces.couples_particles())
    return general_.step(forces, times, state, work);
  general_.forget(Change::state);
  return FusedStepper::step(forces, times, state, work);
}

Work FusedRk4::correct_work(ForceModel& forces, const StepTimes& times, const ClothState& state) {
  return general_.correct_work(forces, times, state);
}

void FusedRk4::sweep(ForceModel& forces, const StepTimes& times, std::span<double> speed_squares,
                     ClothState& state, Work& work) {
  sums_.resize(speed_squares.size());
  forces.sweep()->runge_kutta(times.step, loads_at(forces, kutta_times(times)), sums_, state);
  for (std::size_t k = 0; k < sums_.size(); ++k) {
    double loss = 0, given = 0;
    for (std::size_t s = 0; s < kutta_stages; ++s) {
      loss += kutta[s].weight * (forces.swept().damping * sums_[k].squares[s] + sums_[k].dampers[s]);
      given += kutta[s].weight * sums_[k].air[s];
    }
    work.damping_loss += times.step * loss;
    work.air += times.step * given;
    speed_squares[k] = sums_[k].after;
  }
}

}  // namespace cloth
