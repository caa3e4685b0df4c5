// Contact particle by particle after steps that are long compared with the springs' oscillations. Moving each
// particle alone to the nearest surface would stretch its springs, which have relaxed through the obstacle
// within the step, and so create energy. Instead contact becomes a constraint of the step's own equation.
//
// A step of an implicit method ends at the minimum x* of |x - x~|^2_M / (2 w^2) + V(x), w the weight of the
// force in the step. With x outside the obstacles, that function's gradient at x is
//
//     g(x) = M (x - x*)/w^2 - (f(x, v) - f(x*, v*)) + r = sum of l n,    l >= 0, only where x is on a surface
//
// so that the cloth around a contact deforms within the step, and l w is the normal impulse. Damping is part
// of f, and v = v* + (x - x*)/w (LongStepSolver): were it left as it was at x*, the ledger would book losses
// at velocities that no damper has slowed. r is the gradient at x*: 0 of methods that solve the step, and of
// those that take a number of iterations what is left (Integrator::force_left()), so that a step with contact
// is solved. Were that left out, the shape that contact leads to would be held by forces that nothing has,
// and gain energy by them.
//
// Solved by Newton's method with an active set: particles are constrained in the normal direction (as in
// Baraff and Witkin 1998) while the normal component of g is positive. Until the solve ends a particle is
// kept outside of the side that it met first, beyond its edges too: let go there, it may come back under the
// edge in the next iteration, and so for ever. Friction acts on velocities afterwards.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contact/long_step_solver.h"
#include "contact/obstacle_contact.h"
#include "forces/force_model.h"

namespace cloth {

class StiffContact {
 public:
  /// Moves `position`, the result of the step, out of the obstacles. Returns the particles in contact, in
  /// their order.
  std::vector<HeldParticle> solve(const ClothSystem& system, ForceModel& forces,
                                  std::span<const Obstacle> obstacles, const LongStep& step,
                                  Vec3Field& position);

 private:
  /// Of a particle and an obstacle, in one solve.
  struct Side {
    Vec3 normal{0, 0, 0};  ///< outward, where the surface was met
    bool is_met = false;
    bool is_active = false;  ///< the particle moves along the surface: its normal force is > 0
  };
  void begin_solve(std::span<const Obstacle> obstacles, const Vec3Field& begin, std::size_t particles);
  Side& side_of(std::size_t particle, std::size_t obstacle) {
    return sides_[particle * obstacles_.size() + obstacle];
  }
  std::optional<SurfacePoint> place_on(std::size_t obstacle, const Side& side, const Vec3& begin,
                                       const Vec3& point) const;
  void hold(const ClothSystem& system, Vec3Field& position);
  void find_residual(const ClothSystem& system, ForceModel& forces, const LongStep& step,
                     const Vec3Field& position);
  void release();
  void keep_along_surfaces(Vec3Field& field) const;
  bool find_direction(const ClothSystem& system, ForceModel& forces, const LongStep& step,
                      const Vec3Field& position);

  Vec3Field begin_;  ///< m
  Vec3Field residual_, direction_, start_, along_;
  std::vector<HeldParticle> held_;  ///< on a surface; after release() with a normal force > 0
  std::span<const Obstacle> obstacles_;
  std::vector<Obstacle> reached_;             ///< grown by what is rounding
  std::vector<Side> sides_, sides_at_start_;  ///< of each particle, one after the other for each obstacle
  LongStepSolver solver_;
};

}  // namespace cloth
