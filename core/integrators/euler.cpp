#include "integrators/euler.h"

namespace cloth {
namespace {

void evaluate(ForceModel& forces, const StepTimes& times, const ClothState& state, Vec3Field& force,
              Work& work) {
  if (force.size() != state.position.size()) force = Vec3Field(state.position.size());
  forces.update(state.position, times.begin);
  work += times.step * forces.force_and_power(state.position, state.velocity, force);
}

IntegratorReport unseen(ForceModel& forces, double step, bool drift_first, std::span<double> speed_squares,
                        ClothState& state, Work& work) {
  forces.euler_steps(step, drift_first, speed_squares, state, work);
  return {.force_evaluations = 1, .speed_squares = speed_squares.back()};
}

}  // namespace

IntegratorReport ExplicitEuler::step(const ClothSystem& system, ForceModel& forces, const StepTimes& times,
                                     ClothState& state, Work& work) {
  if (const auto squares = forces.euler_step(times.begin, times.step, true, state, work))
    return {.force_evaluations = 1, .speed_squares = squares};
  evaluate(forces, times, state, force_, work);
  add_scaled(times.step, state.velocity, state.position);
  add_acceleration(system, times.step, force_, state.velocity);
  return {.force_evaluations = 1};
}

IntegratorReport SemiImplicitEuler::step(const ClothSystem& system, ForceModel& forces,
                                         const StepTimes& times, ClothState& state, Work& work) {
  if (!constraint_ || !constraint_->holds()) {
    if (constraint_) constraint_->before_kick(times.step, times.step, state);
    if (const auto squares = forces.euler_step(times.begin, times.step, false, state, work)) {
      if (constraint_) constraint_->after_drift(0, state);
      return {.force_evaluations = 1, .speed_squares = squares};
    }
  }
  evaluate(forces, times, state, force_, work);
  if (constraint_) constraint_->before_kick(times.step, times.step, state);
  add_acceleration(system, times.step, force_, state.velocity);
  add_scaled(times.step, state.velocity, state.position);
  if (constraint_) constraint_->after_drift(0, state);
  return {.force_evaluations = 1};
}

IntegratorReport ExplicitEuler::unseen_steps(ForceModel& forces, double step, std::span<double> speed_squares,
                                             ClothState& state, Work& work) {
  return unseen(forces, step, true, speed_squares, state, work);
}

IntegratorReport SemiImplicitEuler::unseen_steps(ForceModel& forces, double step,
                                                 std::span<double> speed_squares, ClothState& state,
                                                 Work& work) {
  return unseen(forces, step, false, speed_squares, state, work);
}

}  // namespace cloth
