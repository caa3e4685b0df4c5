#include "integrators/implicit_methods.h"

#include <utility>

namespace cloth {

IntegratorReport ImplicitEuler::step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                     Work& work) {
  IntegratorReport report;
  velocity_ = state.velocity;
  stage_.solve({forces, stage_weight * times.step, times.end, state.position, state.velocity, velocity_,
                position_, report});
  std::swap(state.position, position_);
  std::swap(state.velocity, velocity_);
  if (forces.has_power()) end_power_ = forces.power(state.position, state.velocity);
  end_weight_ = times.step;
  work += end_weight_ * end_power_;
  return report;
}

IntegratorReport ImplicitMidpoint::step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                        Work& work) {
  IntegratorReport report;
  const double half = stage_weight * times.step;
  velocity_ = state.velocity;
  stage_.solve(
      {forces, half, times.begin + half, state.position, state.velocity, velocity_, position_, report});
  if (forces.has_power()) work += times.step * forces.power(position_, velocity_);
  add_scaled(times.step, velocity_, state.position);
  const auto v = state.velocity.flat();
  const auto middle = velocity_.flat();
  for (std::size_t k = 0; k < v.size(); ++k) v[k] = 2 * middle[k] - v[k];
  return report;
}

IntegratorReport Bdf2::step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) {
  if (history_ == History::held && times.step != step_before_) history_ = History::broken;
  Work of_step;
  IntegratorReport report;
  if (history_ == History::held) {
    report = multistep(forces, times, state, of_step);
    last_weight_ = stage_weight;
  } else {
    before_ = state;
    const bool is_first = history_ == History::none;
    report =
        is_first ? midpoint_.step(forces, times, state, of_step) : euler_.step(forces, times, state, of_step);
    last_weight_ = is_first ? midpoint_.last_stage_weight() : euler_.last_stage_weight();
    end_weight_ = is_first ? 0 : times.step;
    end_power_ = 1 / times.step * of_step;
  }
  history_ = History::held;
  step_before_ = times.step;
  work_before_ = of_step;
  work += of_step;
  return report;
}

IntegratorReport Bdf2::multistep(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) {
  IntegratorReport report;
  const double weight = stage_weight * times.step;
  const auto extrapolate = [](const Vec3Field& now, const Vec3Field& before, Vec3Field& known) {
    known = now;
    const auto from = before.flat();
    const auto to = known.flat();
    for (std::size_t k = 0; k < to.size(); ++k) to[k] += (to[k] - from[k]) / 3;
  };
  extrapolate(state.position, before_.position, known_position_);
  extrapolate(state.velocity, before_.velocity, known_velocity_);
  velocity_ = state.velocity;
  stage_.solve({forces, weight, times.end, known_position_, known_velocity_, velocity_, position_, report});
  before_.position = std::move(state.position);
  before_.velocity = std::move(state.velocity);
  state.position = position_;
  state.velocity = velocity_;
  work += (1.0 / 3) * work_before_;
  if (forces.has_power()) end_power_ = forces.power(state.position, state.velocity);
  end_weight_ = weight;
  work += end_weight_ * end_power_;
  return report;
}

void Bdf2::forget(Change change) {
  if (change == Change::state && history_ == History::held) history_ = History::broken;
}

IntegratorMemory Bdf2::remember() const {
  IntegratorMemory memory{.fields = {}, .numbers = {static_cast<double>(history_)}};
  if (history_ != History::held) return memory;
  memory.fields = {before_.position, before_.velocity};
  memory.numbers.insert(memory.numbers.end(), {step_before_, work_before_.damping_loss, work_before_.air,
                                               work_before_.brush, work_before_.pull});
  return memory;
}

void Bdf2::recall(const IntegratorMemory& memory) {
  history_ = static_cast<History>(memory.numbers.at(0));
  if (history_ != History::held) return;
  before_.position = memory.fields.at(0);
  before_.velocity = memory.fields.at(1);
  step_before_ = memory.numbers.at(1);
  work_before_ = {.damping_loss = memory.numbers.at(2),
                  .air = memory.numbers.at(3),
                  .brush = memory.numbers.at(4),
                  .pull = memory.numbers.at(5)};
}

}  // namespace cloth
