#include "integrators/verlet.h"

namespace cloth {

IntegratorReport Verlet::step(const ClothSystem& system, ForceModel& forces, const StepTimes& times,
                              ClothState& state, Work& work) {
  IntegratorReport report;
  const double h = times.step;
  if (!holds_position_force_) {
    forces.update(state.position, times.begin);
    ++report.force_evaluations;
  }
  if (forces.steps_verlet()) {
    if (!holds_position_force_ && forces.has_power()) power_ = forces.power(state.velocity);
    work += 0.5 * h * power_;
    report.speed_squares = forces.verlet_step(h, state, power_);
    work += 0.5 * h * power_;
    ++report.force_evaluations;
    holds_position_force_ = true;
    return report;
  }

  if (!holds_force_) evaluate(forces, state.velocity);
  work += 0.5 * h * power_;
  add_acceleration(system, 0.5 * h, force_, state.velocity);
  add_scaled(h, state.velocity, state.position);
  forces.update(state.position, times.end);
  ++report.force_evaluations;
  report.velocity_iterations = finish_velocity(system, forces, 0.5 * h, state);
  evaluate(forces, state.velocity);
  work += 0.5 * h * power_;
  holds_position_force_ = true;
  return report;
}

/// f and its power, at the positions of the last update.
void Verlet::evaluate(ForceModel& forces, const Vec3Field& velocity) {
  if (force_.size() != velocity.size()) force_ = Vec3Field(velocity.size());
  power_ = forces.force_and_power(velocity, force_);
  holds_force_ = true;
}

/// From the velocity at half the step; `force_` holds the force that led there. Returns the iterations.
int Verlet::finish_velocity(const ClothSystem& system, ForceModel& forces, double half_step,
                            ClothState& state) {
  holds_force_ = false;
  if (!forces.has_damping()) {
    forces.force(state.velocity, force_);
    add_acceleration(system, half_step, force_, state.velocity);
    return 0;
  }
  half_velocity_ = state.velocity;
  add_acceleration(system, half_step, force_, state.velocity);  // the guess: v + h a(x, v, t)
  return forces.centred_velocity(half_step, half_velocity_, state.velocity);
}

/// Else the cloth beside a contact would feel the springs of where contact let nobody go, and at rest keep a
/// speed of some omega^2 h^3 g that no position follows.
void Verlet::follow_positions(const ClothSystem& system, ForceModel& forces, const StepTimes& times,
                              const Vec3Field& half_velocity, ClothState& state) {
  if (force_.size() != state.position.size()) force_ = Vec3Field(state.position.size());
  state.velocity = half_velocity;
  forces.update(state.position, times.end);
  forces.force(state.velocity, force_);
  finish_velocity(system, forces, 0.5 * times.step, state);
}

/// Else the cloth beside a contact would be damped by how fast that would have gone without it, and at rest
/// keep a speed of some h^2 g times damping over mass.
void Verlet::follow_velocities(const ClothSystem& system, ForceModel& forces, const StepTimes& times,
                               const Vec3Field& half_velocity, ClothState& state) {
  holds_force_ = false;
  forces.force(state.velocity, force_);
  state.velocity = half_velocity;
  add_acceleration(system, 0.5 * times.step, force_, state.velocity);
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
