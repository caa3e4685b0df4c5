// Solves (m + weight D) v = m known + weight p for the velocities v of the free particles: damping that is
// implicit in the velocity at the end of a step, as Verlet needs it. Where D does not couple particles
// (viscous damping, air) every particle has a 3x3 system with a closed solution. Spring damping couples
// particles: the system is then solved by conjugate gradients, preconditioned by the closed solution for the
// other forces.
#pragma once

#include <vector>

#include "forces/force_model.h"

namespace cloth {

/// Far below any method's error, so that the order of the step is not touched.
inline constexpr double solved_tolerance = 1e-13;

class VelocitySolver {
 public:
  /// p and D are those of the last update of `forces`, which was at `position`; `weight` in s. The residual
  /// falls below `tolerance` times the right-hand side, both in the norm of the inverse of the matrix' part
  /// that couples no particles. In: `velocity`
  /// holds `known`, `force` an estimate of p - D v in N, from which the iteration starts. Out: `velocity` is
  /// v; pinned particles keep 0; `force` is overwritten. Returns the number of iterations; 0 where the
  /// solution is closed.
  int solve(const ForceModel& forces, double weight, double tolerance, const Vec3Field& position,
            Vec3Field& velocity, Vec3Field& force);

 private:
  void solve_by_particle(const ClothSystem& system, const Vec3Field& position_force, double weight,
                         const NodeDamping& damping, Vec3Field& velocity);
  /// sum of visit(first, count, own) over all strips, in their order; `own` is scratch.
  template <class Visit>
  double sum_over_strips(std::size_t size, const Visit& visit);
  int solve_coupled(const ForceModel& forces, double weight, double tolerance, const NodeDamping& local,
                    const Vec3Field& position, Vec3Field& velocity, Vec3Field& product);

  WorkerTeam* team_ = nullptr;            ///< of this solve
  std::vector<double> of_strips_;         ///< scratch
  std::vector<double> inverse_diagonal_;  ///< 1/kg, scratch
  Vec3Field residual_, direction_;        ///< scratch, sized when first needed
};

}  // namespace cloth
