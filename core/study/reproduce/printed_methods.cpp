#include "study/reproduce/printed_methods.h"

#include <utility>

#include "forces/force_model.h"

namespace cloth {

IntegratorReport PrintedRk4::step(const ClothSystem& system, ForceModel& forces, const StepTimes& times,
                                  ClothState& state, Work&) {
  constexpr std::array<double, 4> nodes{0, 0.5, 0.5, 1};
  constexpr std::array<double, 4> weights{1.0 / 6, 2.0 / 6, 3.0 / 6, 1.0 / 6};  // as printed
  const double h = times.step;
  if (force_.size() != state.position.size()) force_ = Vec3Field(state.position.size());
  stage_position_ = next_position_ = state.position;
  stage_velocity_ = next_velocity_ = state.velocity;
  for (std::size_t s = 0; s < nodes.size(); ++s) {
    forces.update(stage_position_, times.begin + nodes[s] * h);
    forces.force(stage_position_, stage_velocity_, force_);
    add_scaled(h * weights[s], stage_velocity_, next_position_);
    add_acceleration(system, h * weights[s], force_, next_velocity_);
    if (s + 1 == nodes.size()) break;
    const double ahead = h * nodes[s + 1];
    stage_position_ = state.position;
    add_scaled(ahead, stage_velocity_, stage_position_);
    stage_velocity_ = state.velocity;
    add_acceleration(system, ahead, force_, stage_velocity_);
  }
  std::swap(state.position, next_position_);
  std::swap(state.velocity, next_velocity_);
  return {.force_evaluations = 4};
}

IntegratorReport PrintedVerlet::step(const ClothSystem& system, ForceModel& forces, const StepTimes& times,
                                     ClothState& state, Work&) {
  const double h = times.step;
  if (force_.size() != state.position.size()) force_ = Vec3Field(state.position.size());
  forces.update(state.position, times.begin);
  forces.force(state.position, state.velocity, force_);
  if (!previous_) {  // the start by Taylor's formula: x(t-h) = x - h v + h^2/2 a
    previous_ = state.position;
    add_scaled(-h, state.velocity, *previous_);
    add_acceleration(system, 0.5 * h * h, force_, *previous_);
  }
  next_ = state.position;
  add_scaled(1, state.position, next_);
  add_scaled(-1, *previous_, next_);
  add_acceleration(system, h * h, force_, next_);
  state.velocity.fill(0);
  add_scaled(1 / h, next_, state.velocity);
  add_scaled(-1 / h, state.position, state.velocity);
  *previous_ = std::exchange(state.position, next_);
  return {.force_evaluations = 1};
}

}  // namespace cloth
