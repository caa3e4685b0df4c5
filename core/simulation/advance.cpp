// Several steps of which only the last state is looked at.
#include <algorithm>
#include <array>

#include "simulation/simulation.h"

namespace cloth {
namespace {

/// Fewer are not worth the copy of the state; more would keep whoever waits for an answer.
constexpr std::int64_t fewest = 8, most_at_once = 32;

}  // namespace

std::optional<Divergence> Simulation::advance(std::int64_t steps) {
  while (steps > 0) {
    const std::int64_t part = std::min(steps, most_at_once);
    const std::int64_t taken = advance_unseen(part);
    steps -= taken;
    for (std::int64_t n = taken; n < part; ++n, --steps)
      if (auto divergence = step()) return divergence;
  }
  return std::nullopt;
}

/// Takes `count` steps at once, or none: where the scene needs every state, where the method cannot, and
/// where one of the steps has to be looked at more closely.
std::int64_t Simulation::advance_unseen(std::int64_t count) {
  if (count < fewest || limiter_ || contact_ || continuous_contact_ || !was_finite_ ||
      !integrator_->gains_unseen(*forces_))
    return 0;
  std::array<double, most_at_once> squares{};
  const std::span<double> of_steps(squares.data(), static_cast<std::size_t>(count));
  forces_->copy(state_, before_unseen_);
  const Work work = ledger_.forces;
  const IntegratorReport report =
      integrator_->unseen_steps(*forces_, time_step_, of_steps, state_, ledger_.forces);
  if (!std::all_of(of_steps.begin(), of_steps.end(), [this](double s) { return is_surely_slow(s); })) {
    state_ = before_unseen_;
    ledger_.forces = work;
    integrator_->forget(Change::state);
    return 0;
  }
  state_.step += count;
  state_.time = first_time_ + static_cast<double>(state_.step - first_step_) * time_step_;
  for (std::int64_t n = 0; n < count; ++n) count_step(report);
  return count;
}

}  // namespace cloth
