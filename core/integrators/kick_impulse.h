// The work of damping in a step of a Runge-Kutta method where powers at its stages do not give it: where
// dampers are stiff for the step, and where contact has changed velocities abruptly. Everything that depends
// on the velocity gives a particle the impulse
//
//     J = m (v' - v) - h sum b p,
//
// b the weights of the stages and p their forces of the positions, and does the work J . (v + v')/2, which is
// exactly what the kinetic energy changes by. Contact that then changes v' changes that work too: a particle
// that it holds has moved within the step, and dampers with it, as it has not.
#pragma once

#include "forces/force_model.h"

namespace cloth {

class KickImpulse {
 public:
  /// A step of so many particles begins.
  void reset(std::size_t particles);
  /// p in N acts for `duration` s, a part of the step.
  void add(double duration, const Vec3Field& position_force);
  /// The step leads from v to v'. Fields have zero velocities for pinned particles.
  void close(const ClothSystem& system, const Vec3Field& begin, const Vec3Field& end);

  /// J, of all that depends on the velocity. `position` (m) is that of the last update of `forces`, `step` s.
  Work work(const ForceModel& forces, const Vec3Field& position, double step);
  /// J, what a change of v' to `changed` adds to the work of damping.
  double work_of_change(const Vec3Field& changed) const;

 private:
  Vec3Field impulse_;             ///< N s; before close() what p has given
  Vec3Field begin_, end_, mean_;  ///< m/s
};

}  // namespace cloth
