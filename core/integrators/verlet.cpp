#include "integrators/verlet.h"

namespace cloth {

IntegratorReport Verlet::step(const ClothSystem& system, ForceModel& forces, const StepTimes& times,
                              ClothState& state, Work& work) {
  IntegratorReport report;
  const double h = times.step;
  if (!holds_force_) {
    forces.update(state.position, times.begin);
    if (forces.has_power()) power_ = forces.power(state.velocity);
    ++report.force_evaluations;
  }
  if (forces.has_power()) work += 0.5 * h * power_;
  report.speed_squares = forces.verlet_step(h, state, power_);
  if (report.speed_squares) {
    if (forces.has_power()) work += 0.5 * h * power_;
    ++report.force_evaluations;
    holds_force_ = true;
    return report;
  }

  if (force_.size() != state.position.size()) force_ = Vec3Field(state.position.size());
  forces.force(state.velocity, force_);
  add_acceleration(system, 0.5 * h, force_, state.velocity);
  add_scaled(h, state.velocity, state.position);
  forces.update(state.position, times.end);
  ++report.force_evaluations;

  if (forces.has_damping()) {
    half_velocity_ = state.velocity;
    add_acceleration(system, 0.5 * h, force_, state.velocity);  // the guess: v + h a(x, v, t)
    report.velocity_iterations = forces.centred_velocity(0.5 * h, half_velocity_, state.velocity);
  } else {
    forces.force(state.velocity, force_);
    add_acceleration(system, 0.5 * h, force_, state.velocity);
  }
  if (forces.has_power()) {
    power_ = forces.power(state.velocity);
    work += 0.5 * h * power_;
  }
  holds_force_ = true;
  return report;
}

}  // namespace cloth
