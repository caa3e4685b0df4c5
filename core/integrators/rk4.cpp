#include "integrators/rk4.h"

#include <utility>

namespace cloth {

std::array<double, kutta_stages> kutta_times(const StepTimes& times) {
  std::array<double, kutta_stages> at{};
  for (int s = 0; s < kutta_stages; ++s)
    at[static_cast<std::size_t>(s)] =
        kutta[s].node == 1 ? times.end : times.begin + kutta[s].node * times.step;
  return at;
}

IntegratorReport Rk4::step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) {
  const double h = times.step;
  const auto at = kutta_times(times);
  if (force_.size() != state.position.size()) force_ = Vec3Field(state.position.size());
  stage_position_ = state.position;
  stage_velocity_ = state.velocity;
  next_position_ = state.position;
  next_velocity_ = state.velocity;

  kicks_are_known_ = std::exchange(has_touched_, false) && forces.couples_particles();
  if (kicks_are_known_) kicks_.reset(state.position.size());
  Work of_step;
  for (int s = 0; s < kutta_stages; ++s) {
    forces.update(stage_position_, at[static_cast<std::size_t>(s)]);
    of_step += h * kutta[s].weight * forces.force_and_power(stage_position_, stage_velocity_, force_);
    if (kicks_are_known_) kicks_.add(h * kutta[s].weight, forces.position_force());
    add_scaled(h * kutta[s].weight, stage_velocity_, next_position_);
    add_acceleration(forces.system(), h * kutta[s].weight, force_, next_velocity_);
    if (s + 1 == kutta_stages) break;

    const double ahead = h * kutta[s + 1].node;
    stage_position_ = state.position;
    add_scaled(ahead, stage_velocity_, stage_position_);
    stage_velocity_ = state.velocity;
    add_acceleration(forces.system(), ahead, force_, stage_velocity_);
  }
  if (kicks_are_known_) kicks_.close(forces.system(), state.velocity, next_velocity_);
  work += kicks_are_known_ ? kicks_.work(forces, stage_position_, h) : of_step;
  std::swap(state.position, next_position_);
  std::swap(state.velocity, next_velocity_);
  return {.force_evaluations = kutta_stages};
}

Work Rk4::correct_work(ForceModel&, const StepTimes&, const ClothState& state) {
  has_touched_ = true;
  if (!kicks_are_known_) return {};
  return {.damping_loss = -kicks_.work_of_change(state.velocity)};
}

}  // namespace cloth
