// State that contact carries over from one step to the next.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace cloth {

struct ContactMemory {
  /// Of each particle: whether contact acted on it at the end of the step without restitution. In the next
  /// step its approach is then load, not an impact.
  std::vector<std::uint8_t> held;
  /// J, of each particle: kinetic energy that the impulse at the end of the step has taken and the impulse at
  /// the beginning of the next step returns. Only for Verlet's method.
  std::vector<double> deferred;

  void resize(std::size_t particles) {
    held.resize(particles, 0);
    deferred.resize(particles, 0.0);
  }
  /// Resets; returns the sum of the deferred energy, in J.
  double clear() {
    const double sum = std::accumulate(deferred.begin(), deferred.end(), 0.0);
    held.clear(), deferred.clear();
    return sum;
  }
};

}  // namespace cloth
