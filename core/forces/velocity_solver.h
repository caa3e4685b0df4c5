// The damping centred in time, as Verlet needs it: (m + weight D) v = m known + weight p for the velocity of
// the free particles. Where D couples no particles (viscous damping, air) every particle has a 3x3 system
// with a closed solution; spring damping couples them and takes a few steps of conjugate gradients,
// preconditioned by the closed solution of the rest.
#pragma once

#include <vector>

#include "forces/force_model.h"

namespace cloth {

class VelocitySolver {
 public:
  /// p and D are those of the last update of `forces`, which was at `position`; `weight` in s. `velocity`
  /// holds `known` and becomes v; pinned particles keep 0. `force` holds about p - D v, in N, from which
  /// the solution starts, and is scratch. Returns the iterations of conjugate gradients; 0 where the
  /// solution is closed.
  int solve(const ForceModel& forces, double weight, const Vec3Field& position, Vec3Field& velocity,
            Vec3Field& force);

 private:
  void solve_by_particle(const ClothSystem& system, const Vec3Field& position_force, double weight,
                         const NodeDamping& damping, Vec3Field& velocity);
  int solve_coupled(const ForceModel& forces, double weight, const NodeDamping& local,
                    const Vec3Field& position, Vec3Field& velocity, Vec3Field& product);

  std::vector<double> inverse_diagonal_;  ///< 1/kg, scratch
  Vec3Field residual_, direction_;        ///< scratch, sized when first needed
};

}  // namespace cloth
