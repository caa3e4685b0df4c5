// Several steps in batches, and the length of a step.
#include <algorithm>
#include <array>
#include <cmath>

#include "measure/stability_limit.h"
#include "simulation/simulation.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

/// Fewer are not worth the copy of the state; more would keep whoever waits for an answer.
constexpr std::int64_t fewest = 8, max_at_once = 32;

}  // namespace

std::optional<Divergence> Simulation::advance(std::int64_t steps) {
  while (steps > 0) {
    begin_step_length();
    std::int64_t part = std::min(steps, max_at_once);
    if (watches_step_) part = std::min(part, ledger_interval - run_.state.step % ledger_interval);
    if (run_.automatic.next_change >= 0) part = std::min(part, run_.automatic.next_change - run_.state.step);
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
  if (count < fewest || limiter_ || contact_ || !was_finite_ || !integrator_->gains_from_batches(*forces_))
    return 0;
  std::array<double, max_at_once> squares{};
  const std::span<double> of_steps(squares.data(), static_cast<std::size_t>(count));
  forces_->sweep()->copy(run_.state, before_batch_);
  const Work work = run_.ledger.forces;
  const IntegratorReport report =
      integrator_->step_many(*forces_, run_.time_step, of_steps, run_.state, run_.ledger.forces);
  if (!std::all_of(of_steps.begin(), of_steps.end(), [this](double s) { return is_surely_slow(s); })) {
    run_.state = before_batch_;
    run_.ledger.forces = work;
    integrator_->forget(Change::state);
    return 0;
  }
  run_.state.step += count;
  run_.state.time = run_.first_time + static_cast<double>(run_.state.step - run_.first_step) * run_.time_step;
  for (std::int64_t n = 0; n < count; ++n) count_step(report);
  return count;
}

std::int64_t Simulation::steps_to_row() const {
  if (run_.automatic.next_change >= 0) return run_.automatic.next_change - run_.first_step;
  return steps_per_row(scene_.record.interval, run_.time_step);
}

/// Puts the step in force that the scene says, where that is another one than before.
void Simulation::take_step_of_scene() {
  const double longest = resolved_time_step(scene_).value();
  const bool watched = is_step_watched(scene_);
  watches_ledger_ = watched || stable_at_every_step(scene_.integrator.method);
  if (longest == run_.automatic.longest && watched == watches_step_) return;
  watches_step_ = watched;
  run_.first_time = run_.state.time;
  run_.first_step = run_.state.step;
  run_.time_step = longest;
  run_.automatic = {.longest = longest,
                    .origin = run_.state.time,
                    .least_error = infinity,  // what came before is not this step's
                    .changes = std::move(run_.automatic.changes)};
}

/// At the end of the record interval within which the step was shortened.
void Simulation::begin_step_length() {
  if (run_.automatic.next_change != run_.state.step) return;
  run_.first_time = run_.state.time;
  run_.first_step = run_.state.step;
  run_.time_step = run_.automatic.next_time_step;
  run_.automatic.next_change = -1;
}

/// Every few steps, or at once where the cloth is as fast as all that the scene could give: a stretched start
/// that is let go can heat within a few steps.
void Simulation::watch_step(bool at_once) {
  if (!watches_step_ || !(at_once || run_.state.step % ledger_interval == 0)) return;
  const Energy energy = energy_of(run_.state);
  const double error = energy.total() - run_.ledger.initial - run_.ledger.entered();
  if (asks_for_shorter(run_.automatic, error / energy_scale_after(-energy.gravity))) shorten_step();
}

/// What is left of the record interval is divided into whole steps of its own, so that rows stay where they
/// are.
void Simulation::shorten_step() {
  constexpr double slack = 1e-6;  // of a step
  const double interval = scene_.record.interval;
  const double step = interval / static_cast<double>(steps_after_shortening(interval, run_.automatic.longest,
                                                                            run_.automatic.shortened));
  const double intervals = (run_.state.time - run_.automatic.origin) / interval;
  const double left = interval * (std::floor(intervals + slack * step / interval) + 1 - intervals);
  const double parts = std::max(1.0, std::ceil(left / step - slack));
  run_.first_time = run_.state.time;
  run_.first_step = run_.state.step;
  const bool whole = left > interval * (1 - slack * step / interval);
  run_.time_step = whole ? step : left / parts;
  run_.automatic.next_change = whole ? -1 : run_.state.step + static_cast<std::int64_t>(parts);
  run_.automatic.next_time_step = step;
  run_.automatic.changes.push_back({run_.state.step, run_.state.time, step});
}

}  // namespace cloth
