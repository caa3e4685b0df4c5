#include "integrators/rk4.h"

#include <utility>

namespace cloth {
namespace {

struct Stage {
  double node;  ///< where in the step the stage stands, and how far it follows the slope before it
  double weight;
};
constexpr std::array<Stage, 4> kutta{{{0, 1.0 / 6}, {0.5, 1.0 / 3}, {0.5, 1.0 / 3}, {1, 1.0 / 6}}};

}  // namespace

IntegratorReport Rk4::step(const ClothSystem& system, ForceModel& forces, const StepTimes& times,
                           ClothState& state, Work& work) {
  const double h = times.step;
  std::array<double, kutta.size()> at;
  for (std::size_t s = 0; s < kutta.size(); ++s)
    at[s] = kutta[s].node == 1 ? times.end : times.begin + kutta[s].node * h;
  if (const auto squares = forces.runge_kutta_step(at, h, state, work))
    return {.force_evaluations = 4, .speed_squares = squares};
  if (force_.size() != state.position.size()) force_ = Vec3Field(state.position.size());
  stage_position_ = state.position;
  stage_velocity_ = state.velocity;
  next_position_ = state.position;
  next_velocity_ = state.velocity;

  for (std::size_t s = 0; s < kutta.size(); ++s) {
    forces.update(stage_position_, at[s]);
    work += h * kutta[s].weight * forces.force_and_power(stage_position_, stage_velocity_, force_);
    add_scaled(h * kutta[s].weight, stage_velocity_, next_position_);
    add_acceleration(system, h * kutta[s].weight, force_, next_velocity_);
    if (s + 1 == kutta.size()) break;

    const double ahead = h * kutta[s + 1].node;
    stage_position_ = state.position;
    add_scaled(ahead, stage_velocity_, stage_position_);
    stage_velocity_ = state.velocity;
    add_acceleration(system, ahead, force_, stage_velocity_);
  }
  std::swap(state.position, next_position_);
  std::swap(state.velocity, next_velocity_);
  return {.force_evaluations = 4};
}

IntegratorReport Rk4::unseen_steps(ForceModel& forces, double step, std::span<double> speed_squares,
                                   ClothState& state, Work& work) {
  forces.runge_kutta_steps(step, speed_squares, state, work);
  return {.force_evaluations = 4, .speed_squares = speed_squares.back()};
}

}  // namespace cloth
