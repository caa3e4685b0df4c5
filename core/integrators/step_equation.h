// What is left of the equation of an implicit Euler step by methods that take a number of iterations instead
// of solving it (projective dynamics, VBD).
#pragma once

#include "integrators/integrator.h"

namespace cloth {

/// r = M (v' - v) - h f(x', v', t + h) in N s, zero on pins. `end`: x', v'. `force`: f, in N. Updates the
/// force model to the positions of `end`.
void find_step_residual(ForceModel& forces, const StepTimes& times, const Vec3Field& start_velocity,
                        const ClothState& end, Vec3Field& force, Vec3Field& residual);

/// A step as the method has left it, before the deformation rate and contact change it.
class LeftStep {
 public:
  void note(const Vec3Field& start_velocity, const ClothState& end);
  /// r/h at its end, in N.
  const Vec3Field& force_left(ForceModel& forces, const StepTimes& times);

 private:
  Vec3Field start_velocity_, force_, left_;
  ClothState end_;
};

}  // namespace cloth
