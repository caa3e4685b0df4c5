#include "integrators/dormand_prince.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace cloth {
namespace {

constexpr int stages = DormandPrince::stage_count;
constexpr int last = stages - 1;

constexpr std::array<double, stages> node{0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
// Row s leads to stage s; the last row is the solution of order 5.
constexpr std::array<std::array<double, last>, stages> coupling{{
    {},
    {1.0 / 5},
    {3.0 / 40, 9.0 / 40},
    {44.0 / 45, -56.0 / 15, 32.0 / 9},
    {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
}};
// Weights of order 5 less those of order 4.
constexpr std::array<double, stages> error_weight{71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                                  -17253.0 / 339200, 22.0 / 525, -1.0 / 40};

constexpr double safety = 0.9;
constexpr double least_factor = 0.2, largest_factor = 10;
constexpr double history_exponent = 0.04;
constexpr double error_exponent = 0.2 - 0.75 * history_exponent;
constexpr double least_remembered_error = 1e-4;

constexpr int max_attempts = 100000;     // of inner steps in one outer step
constexpr double smallest_step = 1e-14;  // of the outer step
constexpr double stretch_to_end = 1.01;  // rather than leave a sliver for one more step

/// Whether each kind of `work` in `step` s is as much as its powers at the ends let expect, and no stage has
/// far more of it than they.
bool is_resolved(const Work& work, double step, std::span<const Work> power) {
  constexpr double most_power = 1.5, most_beside_trapezoid = 0.2;
  return std::ranges::all_of(
      std::array{&Work::damping_loss, &Work::air, &Work::brush, &Work::pull}, [&](double Work::*kind) {
        const double begin = power.front().*kind, end = power.back().*kind;
        const double bound = most_power * std::max(std::abs(begin), std::abs(end));
        return std::abs(work.*kind - 0.5 * step * (begin + end)) <=
                   most_beside_trapezoid * step * (std::abs(begin) + std::abs(end)) &&
               std::ranges::all_of(power, [&](const Work& of) { return std::abs(of.*kind) <= bound; });
      });
}

}  // namespace

void StepSizeControl::accept(double step, double error) {
  const double wanted = safety * std::pow(error, -error_exponent) *
                        std::pow(last_error_, history_exponent);  // error 0: infinity
  const double factor = std::clamp(wanted, least_factor, rejected_ ? 1.0 : largest_factor);
  // A step cut short to end on time says little about long ones where it would have grown beyond the bound.
  const bool cut_short = step < size_ && wanted >= largest_factor && !rejected_;
  if (!cut_short || step * factor > size_) size_ = step * factor;
  last_error_ = std::max(error, least_remembered_error);
  rejected_ = false;
}

void StepSizeControl::reject(double step, double error) {
  const double wanted = safety * std::pow(error, -error_exponent);
  size_ = step * (std::isfinite(error) ? std::clamp(wanted, least_factor, safety) : least_factor);
  rejected_ = true;
}

void StepSizeControl::forget_history() {
  last_error_ = 1;
  rejected_ = false;
}

void StepSizeControl::recall(const std::vector<double>& numbers) {
  assert(numbers.size() == 3);
  size_ = numbers[0];
  last_error_ = numbers[1];
  rejected_ = numbers[2] != 0;
}

IntegratorMemory DormandPrince::remember() const {
  IntegratorMemory memory{.fields = {}, .numbers = control_.numbers()};
  memory.numbers.push_back(has_touched_ ? 1 : 0);
  return memory;
}

void DormandPrince::recall(const IntegratorMemory& memory) {
  holds_slope_ = false;
  std::vector<double> numbers = memory.numbers;
  has_touched_ = numbers.back() != 0;
  numbers.pop_back();
  control_.recall(numbers);
}

void DormandPrince::forget(Change change) {
  holds_slope_ = false;
  if (change == Change::state) control_.forget_history();
}

/// The slope at position_ and the stage's speed.
void DormandPrince::evaluate(ForceModel& forces, int stage, double time, IntegratorReport& report) {
  forces.update(position_, time);
  power_[stage] = forces.force_and_power(position_, speed_[stage], force_);
  if (stage > 0 && stage < last && forces.has_power())
    add_scaled(coupling[last][stage], forces.position_force(), position_forces_);
  acceleration_[stage].fill(0);
  add_acceleration(forces.system(), 1, force_, acceleration_[stage]);
  ++report.force_evaluations;
}

/// All stages but the first. Leaves the new state in position_ and the last stage's speed.
void DormandPrince::attempt(ForceModel& forces, const ClothState& from, const StepTimes& inner,
                            IntegratorReport& report) {
  if (forces.has_power()) position_forces_.fill(0);
  for (int s = 1; s < stages; ++s) {
    position_ = from.position;
    speed_[s] = from.velocity;
    for (int k = 0; k < s; ++k) {
      if (coupling[s][k] == 0) continue;
      add_scaled(inner.step * coupling[s][k], speed_[k], position_);
      add_scaled(inner.step * coupling[s][k], acceleration_[k], speed_[s]);
    }
    evaluate(forces, s, node[s] == 1 ? inner.end : inner.begin + node[s] * inner.step, report);
  }
}

/// The first stage, where the last step did not leave it.
void DormandPrince::take_slope(ForceModel& forces, double time, const ClothState& state,
                               IntegratorReport& report) {
  position_ = state.position;
  speed_[0] = state.velocity;
  evaluate(forces, 0, time, report);
  if (forces.has_power()) begin_position_force_ = forces.position_force();
}

/// Of an accepted step: by the stages, to the order of the method. Near the bound on stiff damping the
/// velocities of the stages, and with them their powers, are many times those of the solution, and contact
/// leaves neighbours with velocities that differ abruptly; then by impulses (integrators/kick_impulse.h).
/// `corrected`: contact may ask for the impulses.
Work DormandPrince::work_of(const ForceModel& forces, double step, const ClothState& from, bool corrected) {
  Work work;
  for (int s = 0; s < last; ++s) work += step * coupling[last][s] * power_[s];
  const bool by_stages = !has_touched_ && is_resolved(work, step, power_);
  if (by_stages && !corrected) return work;
  kicks_.reset(from.velocity.size());
  kicks_.add(step * coupling[last][0], begin_position_force_);
  kicks_.add(step, position_forces_);
  kicks_.close(forces.system(), from.velocity, speed_[last]);
  return by_stages ? work : kicks_.work(forces, position_, step);
}

/// Returns whether the step goes on.
bool DormandPrince::accept(ForceModel& forces, const StepTimes& inner, ClothState& state, Work& work,
                           IntegratorReport& report) {
  if (contact_) contact_->begin(state);
  const bool corrects = contact_ && forces.couples_particles();
  if (forces.has_power()) {
    work += work_of(forces, inner.step, state, corrects);
    begin_position_force_ = forces.position_force();
  }
  std::swap(state.position, position_);
  state.velocity = speed_[last];
  std::swap(speed_[0], speed_[last]);
  std::swap(acceleration_[0], acceleration_[last]);
  std::swap(power_[0], power_[last]);
  if (!contact_) return true;
  const auto outcome = contact_->correct(inner, state);
  if (corrects) {
    has_touched_ = outcome == InnerStepContact::Outcome::changed;
    if (has_touched_) work.damping_loss -= kicks_.work_of_change(state.velocity);
  }
  if (outcome == InnerStepContact::Outcome::changed) take_slope(forces, inner.end, state, report);
  if (outcome == InnerStepContact::Outcome::ended) holds_slope_ = false;
  return outcome != InnerStepContact::Outcome::ended;
}

/// Within a step what is not finite spreads from spring to spring: the particle where it began.
int DormandPrince::first_without_slope() const {
  for (int s = 0; s < stages; ++s)
    for (int i = 0; i < static_cast<int>(position_.size()); ++i)
      if (!speed_[s][i].allFinite() || !acceleration_[s][i].allFinite()) return i;
  return 0;
}

/// Of the displacement, or of the velocity times the step where that is larger.
DormandPrince::LargestError DormandPrince::estimated_error(const ClothSystem& system, double step) const {
  const double allowed = tolerance_ * system.diagonal;
  LargestError largest;
  for (int i = 0; i < static_cast<int>(position_.size()); ++i) {
    Vec3 moved = Vec3::Zero(), sped = Vec3::Zero();
    for (int s = 0; s < stages; ++s) {
      moved += error_weight[s] * speed_[s][i];
      sped += error_weight[s] * acceleration_[s][i];
    }
    const double error = step * std::max(moved.norm(), step * sped.norm()) / allowed;
    if (!std::isfinite(moved.sum() + sped.sum() + error))
      return {std::numeric_limits<double>::infinity(), first_without_slope()};
    if (error > largest.value) largest = {error, i};
  }
  return largest;
}

void DormandPrince::control(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work,
                            IntegratorReport& report) {
  report.inner_steps = 0;
  double elapsed = 0;
  LargestError error;
  for (int attempts = 0; attempts < max_attempts; ++attempts) {
    const double left = times.step - elapsed;
    const bool ends = stretch_to_end * control_.size() >= left;
    const double h = ends ? left : control_.size();
    if (!ends && h < smallest_step * times.step) break;
    const double begin = times.begin + elapsed;
    const StepTimes inner{begin, ends ? times.end : begin + h, h};
    attempt(forces, state, inner, report);
    error = estimated_error(forces.system(), h);
    if (!(error.value <= 1)) {
      ++report.rejected_steps;
      control_.reject(h, error.value);
      continue;
    }
    const bool goes_on = accept(forces, inner, state, work, report);
    control_.accept(h, error.value);
    ++report.inner_steps;
    if (ends || !goes_on) return;
    elapsed += h;
  }
  report.failure = SolverFailure{
      error.particle,
      fmt::format("error control stopped after {} inner steps and {} rejected ones, {:.3g} s into the step: "
                  "the size is {:.3g} s, and the last error was {:.3g} of what the tolerance {} allows",
                  report.inner_steps, report.rejected_steps, elapsed, control_.size(), error.value,
                  tolerance_)};
}

IntegratorReport DormandPrince::step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                     Work& work) {
  IntegratorReport report;
  const std::size_t size = state.position.size();
  if (force_.size() != size) {
    force_ = Vec3Field(size);
    acceleration_.fill(Vec3Field(size));
    position_forces_ = Vec3Field(size);
    holds_slope_ = false;
  }
  if (!holds_slope_) take_slope(forces, times.begin, state, report);
  holds_slope_ = true;
  if (tolerance_ > 0) {
    control(forces, times, state, work, report);
  } else {
    attempt(forces, state, times, report);
    accept(forces, times, state, work, report);
  }
  return report;
}

}  // namespace cloth
