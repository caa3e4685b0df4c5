#include "simulation/step_batches.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace cloth {

void BatchSize::note(std::int64_t steps, double seconds) {
  constexpr double longest = 0.002;  // s
  constexpr std::int64_t most = 32;
  const double wanted = longest * static_cast<double>(steps) / std::max(seconds, 1e-9);
  steps_ = std::max<std::int64_t>(
      1, static_cast<std::int64_t>(std::min(wanted, static_cast<double>(std::min(2 * steps_, most)))));
}

bool StepBatches::run_to(std::int64_t last) {
  while (!divergence_ && simulation_.state().step < last) {
    const std::int64_t begin = simulation_.state().step;
    const auto start = std::chrono::steady_clock::now();
    divergence_ = simulation_.advance(std::min(last - begin, size_.steps()));
    const double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    size_.note(std::max<std::int64_t>(1, simulation_.state().step - begin), taken);
    seconds_ += taken;
    if (simulation_.interrupted() || (stop_ && stop_())) return false;
  }
  return !divergence_;
}

int machine_threads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

std::int64_t steps_beyond(const Simulation& simulation, double end) {
  const double whole = std::floor((end - simulation.time()) / simulation.time_step());
  const std::int64_t steps = std::max<std::int64_t>(1, static_cast<std::int64_t>(whole) + 1);
  if (!simulation.is_within_interval()) return steps;
  const std::int64_t change = simulation.first_step() + simulation.steps_to_row();
  return std::clamp<std::int64_t>(change - simulation.state().step, 1, steps);
}

}  // namespace cloth
