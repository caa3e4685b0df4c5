// The linear systems of contact after long steps: A = M + w^2 K, w the weight of the force in the step in s,
// K clamped to be positive semidefinite, with what constraints add to the blocks of particles. Solved by
// factors, conjugate gradients or multigrid, whichever is the cheapest for the cloth.
#pragma once

#include "forces/force_model.h"
#include "integrators/implicit/linear_choice.h"
#include "integrators/implicit/linear_solver.h"
#include "integrators/implicit/multigrid_solver.h"

namespace cloth {

class LongStepSolver {
 public:
  /// A at the positions, in kg, for constraints to be added to its blocks.
  Linearisation& linearise(const ClothSystem& system, ForceModel& forces, double weight,
                           const Vec3Field& position);

  /// A solution = right_hand_side; false where that was not found. `position`: that of linearise().
  bool solve(const ClothSystem& system, const Vec3Field& position, const Vec3Field& right_hand_side,
             Vec3Field& solution);

 private:
  LinearMethod method_ = LinearMethod::cholesky;
  Linearisation linearisation_;
  CholeskyFactors factors_;
  BlockJacobi jacobi_;
  MultigridSolver multigrid_;
  ConjugateGradients gradients_;
};

}  // namespace cloth
