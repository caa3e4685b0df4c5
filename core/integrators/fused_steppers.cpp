#include "integrators/fused_steppers.h"

#include "forces/air.h"

namespace cloth {
namespace {

/// What acts beside the elasticity of springs in a step whose forces are taken at `times`, in s.
SweepLoads loads_at(const ForceModel& forces, std::span<const double> times) {
  const SweepTerms& swept = forces.swept();
  SweepLoads loads{.weight = forces.weight(),
                   .damping = swept.damping,
                   .spring_damping = swept.spring_damping,
                   .stretch_time = swept.stretch_time,
                   .bending_time = swept.bending_time};
  if (swept.air) {
    loads.air.drag = swept.air_drag;
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

/// The steps of a batch take all forces at one time.
bool FusedStepper::gains_from_batches(const ForceModel& forces) const {
  const Air* air = forces.swept().air;
  return forces.is_swept_whole() && !(air && air->gust) && forces.sweep()->gains_steps_at_once();
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
  if (constraint_ && constraint_->holds()) return general_.step(forces, times, state, work);
  if (constraint_) constraint_->before_kick(times.step, times.step, state);
  const IntegratorReport report = FusedEuler::step(forces, times, state, work);
  if (constraint_) constraint_->after_drift(0, state);
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
