// Several steps in batches, and the length of a step.
#include <algorithm>
#include <array>
#include <cmath>

#include "forces/gravity.h"
#include "measure/stability_limit.h"
#include "simulation/simulation.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

/// Fewer are not worth the copy of the state; more would keep whoever waits for an answer.
constexpr std::int64_t fewest = 8, most_at_once = 32;

}  // namespace

std::optional<Divergence> Simulation::advance(std::int64_t steps) {
  while (steps > 0) {
    begin_step_length();
    std::int64_t part = std::min(steps, most_at_once);
    if (watches_step_) part = std::min(part, ledger_interval - state_.step % ledger_interval);
    if (automatic_.next_change >= 0) part = std::min(part, automatic_.next_change - state_.step);
    const std::int64_t taken = advance_batch(part);
    steps -= taken;
    if (taken > 0) watch_step(false);
    for (std::int64_t n = taken; n < part; ++n, --steps) {
      if (auto divergence = step()) return divergence;
      if (interrupted_) return std::nullopt;
    }
  }
  return std::nullopt;
}

/// Takes `count` steps at once, or none: where the scene needs every state, where the method cannot, and
/// where one of the steps has to be looked at more closely.
std::int64_t Simulation::advance_batch(std::int64_t count) {
  if (count < fewest || limiter_ || contact_ || continuous_contact_ || !was_finite_ ||
      !integrator_->gains_from_batches(*forces_))
    return 0;
  std::array<double, most_at_once> squares{};
  const std::span<double> of_steps(squares.data(), static_cast<std::size_t>(count));
  forces_->sweep()->copy(state_, before_batch_);
  const Work work = ledger_.forces;
  const IntegratorReport report =
      integrator_->step_many(*forces_, time_step_, of_steps, state_, ledger_.forces);
  if (!std::all_of(of_steps.begin(), of_steps.end(), [this](double s) { return is_surely_slow(s); })) {
    state_ = before_batch_;
    ledger_.forces = work;
    integrator_->forget(Change::state);
    return 0;
  }
  state_.step += count;
  state_.time = first_time_ + static_cast<double>(state_.step - first_step_) * time_step_;
  for (std::int64_t n = 0; n < count; ++n) count_step(report);
  return count;
}

std::int64_t Simulation::steps_to_row() const {
  if (automatic_.next_change >= 0) return automatic_.next_change - first_step_;
  return steps_per_row(scene_.record.interval, time_step_);
}

/// Puts the step in force that the scene says, where that is another one than before.
void Simulation::take_step_of_scene() {
  const double longest = resolved_time_step(scene_).value();
  const bool watched = is_step_watched(scene_);
  watches_ledger_ = watched || stable_at_every_step(scene_.integrator.method);
  if (longest == automatic_.longest && watched == watches_step_) return;
  watches_step_ = watched;
  first_time_ = state_.time;
  first_step_ = state_.step;
  time_step_ = longest;
  automatic_ = {.longest = longest,
                .origin = state_.time,
                .least_error = infinity,  // what came before is not this step's
                .changes = std::move(automatic_.changes)};
}

/// At the end of the record interval within which the step was shortened.
void Simulation::begin_step_length() {
  if (automatic_.next_change != state_.step) return;
  first_time_ = state_.time;
  first_step_ = state_.step;
  time_step_ = automatic_.next_time_step;
  automatic_.next_change = -1;
}

/// Every few steps, or at once where the cloth is as fast as all that the scene could give: a stretched start
/// that is let go can heat within a few steps.
void Simulation::watch_step(bool at_once) {
  if (!watches_step_ || !(at_once || state_.step % ledger_interval == 0)) return;
  const Energy energy = measure_energy(system_, gravity_of(scene_), state_);
  const double error = energy.total() - ledger_.initial - ledger_.entered();
  if (asks_for_shorter(automatic_, error / energy_scale_after(-energy.gravity))) shorten_step();
}

/// What is left of the record interval is divided into whole steps of its own, so that rows stay where they
/// are.
void Simulation::shorten_step() {
  constexpr double slack = 1e-6;  // of a step
  const double interval = scene_.record.interval;
  const double step = interval / static_cast<double>(steps_after_shortening(interval, automatic_.longest,
                                                                            automatic_.shortened));
  const double intervals = (state_.time - automatic_.origin) / interval;
  const double left = interval * (std::floor(intervals + slack * step / interval) + 1 - intervals);
  const double parts = std::max(1.0, std::ceil(left / step - slack));
  first_time_ = state_.time;
  first_step_ = state_.step;
  const bool whole = left > interval * (1 - slack * step / interval);
  time_step_ = whole ? step : left / parts;
  automatic_.next_change = whole ? -1 : state_.step + static_cast<std::int64_t>(parts);
  automatic_.next_time_step = step;
  automatic_.changes.push_back({state_.step, state_.time, step});
}

}  // namespace cloth
