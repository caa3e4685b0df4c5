#include "exact/swing.h"

#include <cmath>
#include <numbers>

#include "exact/bessel_zero.h"

namespace cloth::exact {

double hanging_chain_frequency(double length, double gravity) {
  return first_bessel_zero(0) / 2 * std::sqrt(gravity / length);
}

double pendulum_frequency(double length, double gravity) {
  return std::sqrt(gravity / length);
}

DampedSwing damped_swing(double undamped_frequency, double mass_damping) {
  const double rate = mass_damping / 2;
  const double frequency = std::sqrt((undamped_frequency - rate) * (undamped_frequency + rate));
  return {frequency, 2 * std::numbers::pi * rate / frequency};
}

double mass_damping_of(double first_amplitude, double last_amplitude, int periods, double frequency) {
  return std::log(first_amplitude / last_amplitude) / periods * frequency / std::numbers::pi;
}

}  // namespace cloth::exact
