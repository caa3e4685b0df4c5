#include "kernels/spring_sweep.h"

#include <algorithm>

namespace cloth {

std::optional<double> common_mass(const ClothSystem& system) {
  const auto free = std::find_if(system.inverse_mass.begin(), system.inverse_mass.end(),
                                 [](double inverse) { return inverse != 0; });
  if (free == system.inverse_mass.end()) return std::nullopt;
  for (const double inverse : system.inverse_mass)
    if (inverse != 0 && inverse != *free) return std::nullopt;
  const double mass = system.mass[static_cast<std::size_t>(free - system.inverse_mass.begin())];
  for (const double other : system.mass)
    if (other != mass) return std::nullopt;
  return mass;
}

void SpringSweep::euler_steps(double step, bool drift_first, const SweepLoads& loads,
                              std::span<Squares> squares, ClothState& state) {
  for (Squares& of_step : squares) of_step = euler(step, drift_first, loads, state);
}

int SpringSweep::begin_pass(PassKind kind) {
  ThreadChoice& choice = choices_[static_cast<std::size_t>(kind)];
  const int count = use_ == ThreadUse::always ? threads() : choice.next(threads());
  if (choice.wants_time()) begun_ = std::chrono::steady_clock::now();
  return count;
}

void SpringSweep::end_pass(PassKind kind) {
  ThreadChoice& choice = choices_[static_cast<std::size_t>(kind)];
  if (choice.wants_time())
    choice.took(std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count());
  else
    choice.took(0);
}

}  // namespace cloth
