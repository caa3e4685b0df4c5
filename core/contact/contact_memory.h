// What a step of contact leaves for the next one.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace cloth {

struct ContactMemory {
  /// Of each particle: whether contact held it at the end of the step, by an impulse that was no bounce.
  /// What comes near it then is load, not a blow.
  std::vector<std::uint8_t> held;
  /// J, of each particle: what the impulse at the end of the step has taken from a kinetic energy that the
  /// one at the beginning of the next step gives back. Only where velocities follow positions.
  std::vector<double> deferred;

  void resize(std::size_t particles) {
    held.resize(particles, 0);
    deferred.resize(particles, 0.0);
  }
  /// Forgets all; returns what was lent, in J.
  double clear() {
    const double sum = std::accumulate(deferred.begin(), deferred.end(), 0.0);
    held.clear(), deferred.clear();
    return sum;
  }
};

}  // namespace cloth
