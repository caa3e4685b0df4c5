// Particles that are put out of obstacles after a step that is long beside the springs' oscillations. There
// it is not enough to move each of them to the nearest surface: its springs would be stretched by all that
// they relaxed through the obstacle within the step, and energy would be made that no force has given.
//
// A step of an implicit method ends at the minimum x* of |x - x~|^2_M / (2 w^2) + V(x), w the weight of the
// force in it. With x outside the obstacles, and g the difference of the gradients of that at x and x*,
//
//     g(x) = M (x - x*)/w^2 - (f(x) - f(x*)) = sum of l n,    l >= 0, only where x is on a surface
//
// so that the cloth beside a contact gives way within the step, and l w is the impulse of the contact.
// Newton's method over the particles that are held, where the normal component of g says which (an active
// set; Baraff and Witkin 1998 hold particles so). Friction acts on velocities afterwards.
#pragma once

#include <span>
#include <vector>

#include "contact/obstacle_contact.h"
#include "forces/force_model.h"
#include "integrators/implicit/linear_solver.h"

namespace cloth {

class StiffContact {
 public:
  /// Moves `position`, as the step has left it, out of the obstacles. `weight` in s. Returns where it is
  /// held, in order of the particles.
  std::vector<HeldParticle> solve(const ClothSystem& system, ForceModel& forces,
                                  std::span<const Obstacle> obstacles, double weight, double time,
                                  const Vec3Field& begin, Vec3Field& position);

 private:
  void hold(const ClothSystem& system, std::span<const Obstacle> obstacles, Vec3Field& position);
  void find_residual(const ClothSystem& system, ForceModel& forces, double weight, double time,
                     const Vec3Field& position);
  void release();
  void keep_along_surfaces(Vec3Field& field) const;
  bool find_direction(const ClothSystem& system, ForceModel& forces, double weight,
                      const Vec3Field& position);

  Vec3Field begin_, integrated_position_, integrated_force_;  ///< m, N
  Vec3Field residual_, direction_, start_, along_;
  std::vector<HeldParticle> held_, active_;  ///< on a surface; pressed against it
  Linearisation linearisation_;
  CholeskyFactors factors_;
  BlockJacobi jacobi_;
  ConjugateGradients gradients_;
};

}  // namespace cloth
