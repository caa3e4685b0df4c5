// Contact particle by particle after steps that are long compared with the springs' oscillations. Moving each
// particle alone to the nearest surface would stretch its springs, which have relaxed through the obstacle
// within the step, and so create energy. Instead contact becomes a constraint of the step's own equation.
//
// A step of an implicit method ends at the minimum x* of |x - x~|^2_M / (2 w^2) + V(x), w the weight of the
// force in the step. With x outside the obstacles, and g the difference of that function's gradients at x and
// x*,
//
//     g(x) = M (x - x*)/w^2 - (f(x) - f(x*)) = sum of l n,    l >= 0, only where x is on a surface
//
// so that the cloth around a contact deforms within the step, and l w is the normal impulse. Solved by
// Newton's method with an active set: particles are constrained in the normal direction (as in Baraff and
// Witkin 1998) while the normal component of g is positive. Friction acts on velocities afterwards.
#pragma once

#include <span>
#include <vector>

#include "contact/obstacle_contact.h"
#include "forces/force_model.h"
#include "integrators/implicit/linear_solver.h"

namespace cloth {

class StiffContact {
 public:
  /// Moves `position`, the result of the step, out of the obstacles. `weight` in s. Returns the particles in
  /// contact, in their order.
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
  std::vector<HeldParticle> held_, active_;  ///< on a surface; those with a normal force > 0
  Linearisation linearisation_;
  CholeskyFactors factors_;
  BlockJacobi jacobi_;
  ConjugateGradients gradients_;
};

}  // namespace cloth
