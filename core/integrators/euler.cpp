#include "integrators/euler.h"

namespace cloth {
namespace {

void evaluate(ForceModel& forces, const StepTimes& times, const ClothState& state, Vec3Field& force,
              Work& work) {
  if (force.size() != state.position.size()) force = Vec3Field(state.position.size());
  forces.update(state.position, times.begin);
  work += times.step * forces.force_and_power(state.position, state.velocity, force);
}

}  // namespace

IntegratorReport ExplicitEuler::step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                     Work& work) {
  evaluate(forces, times, state, force_, work);
  add_scaled(times.step, state.velocity, state.position);
  add_acceleration(forces.system(), times.step, force_, state.velocity);
  return {.force_evaluations = 1};
}

IntegratorReport SemiImplicitEuler::step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                         Work& work) {
  evaluate(forces, times, state, force_, work);
  if (constraint_) constraint_->before_kick(times.step, times.step, state);
  add_acceleration(forces.system(), times.step, force_, state.velocity);
  add_scaled(times.step, state.velocity, state.position);
  if (constraint_) constraint_->after_drift(0, state);
  return {.force_evaluations = 1};
}

}  // namespace cloth
