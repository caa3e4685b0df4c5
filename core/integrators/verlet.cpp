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

/// The velocity at the end of a step and at the half of the next are made in one pass, so that the force need
/// not be kept: a third less to bring from memory.
IntegratorReport Verlet::unseen_steps(ForceModel& forces, double step, std::span<double> speed_squares,
                                      ClothState& state, Work& work) {
  forces.verlet_steps(step, speed_squares, state);
  if (forces.has_power())
    for (const double squares : speed_squares) {
      work += 0.5 * step * power_;
      power_ = forces.power_after(squares);
      work += 0.5 * step * power_;
    }
  IntegratorReport report;
  report.force_evaluations = 1;
  report.speed_squares = speed_squares.back();
  return report;
}

}  // namespace cloth
