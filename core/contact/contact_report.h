// The outcome of contact in a step, its contact points for display, and what it carries over to the next
// step.
#pragma once

#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "forces/force.h"
#include "geometry/vec3_field.h"

namespace cloth {

/// An obstacle was stopped, because it would otherwise pass through cloth that cannot move out of its path.
struct Pinch {
  int obstacle = 0;
  int particle = 0;
  Vec3 place{0, 0, 0};  ///< m
  /// What holds the cloth there, as far as it is known; Holder::obstacle refers to `holding_obstacle`.
  enum class Holder { unknown, pin, obstacle, itself } holder = Holder::unknown;
  int holding_obstacle = -1;
};

struct ContactReport {
  bool acted = false;     ///< contact has changed the state
  int contacts = 0;       ///< particles in contact; without continuous contact counted once for each obstacle
  int held_back = 0;      ///< particles that did not reach their target position within the rounds
  double work = 0;        ///< J, given to the cloth by contact's impulses
  Vec3 impulse{0, 0, 0};  ///< N s, given to the cloth; only of continuous contact
  /// The result of Integrator::correct_work() at the velocities of a long step's solution, where continuous
  /// contact has solved for springs and contact together. Friction then changes velocities abruptly, and the
  /// power of dampers at those, times the step, would be more than they take.
  std::optional<Work> force_work;
  double rate_work = 0;         ///< J, of the deformation rate where it was solved for with contact
  int rounds = 0;               ///< of continuous contact
  int velocity_iterations = 0;  ///< of VelocitySolver
  std::size_t pairs = 0;        ///< pairs of near features in the last round
  std::optional<Pinch> pinch;
  bool exhausted =
      false;  ///< the limit of pairs and particles over a step's rounds was reached; treated like a pinch
  bool interrupted = false;  ///< the stop test ended it: the positions are not usable
};

struct ContactMark {
  Vec3 point{0, 0, 0};        ///< m, of the cloth
  Vec3 normal{0, 1, 0};       ///< unit vector, from the obstacle to the cloth
  double normal_impulse = 0;  ///< kg m, of the last step; 0 where it is not known
};

struct ContactMemory {
  /// Of each particle: whether contact acted on it at the end of the step without restitution. In the next
  /// step its approach is then load, not an impact.
  std::vector<std::uint8_t> held;
  /// J, of each particle: Verlet's method takes this kinetic energy with the impulse at the end of a step and
  /// returns it with the impulse at the beginning of the next step.
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
