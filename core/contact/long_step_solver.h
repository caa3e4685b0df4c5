// What the two ways to solve a long step with contact share (contact/stiff_contact.h,
// contact/stiff_target.h): what is left of its equation without contact,
//
//     g(x) = M (x - x*)/w^2 - (f(x, v) - f(x*, v*)) + r,    v = v* + (x - x*)/w
//
// and linear systems with A = M + w D + w^2 K, K clamped to be positive semidefinite, and what constraints
// add to the blocks of particles. They are solved by factors, conjugate gradients or multigrid, whichever is
// the cheapest for the cloth.
#pragma once

#include "contact/rate_tensions.h"
#include "forces/force_model.h"
#include "integrators/implicit/linear_choice.h"
#include "integrators/implicit/linear_solver.h"
#include "integrators/implicit/multigrid_solver.h"

namespace cloth {

/// The step that contact is a constraint of.
struct LongStep {
  double weight = 0;                 ///< s, w
  double end = 0;                    ///< s, its time
  const Vec3Field& begin;            ///< m, the positions
  const Vec3Field& velocity;         ///< m/s, v*, where the method ended
  const Vec3Field* force = nullptr;  ///< N, r; null: 0
  RateTensions* rate = nullptr;      ///< null: none, or it is kept already
};

/// N/m, of the stiffest spring or membrane and the heaviest particle's inertia M/w^2 together. `weight`: w in
/// s.
double largest_resistance(const ClothSystem& system, double weight);

class LongStepSolver {
 public:
  /// `position`: x*.
  void begin(ForceModel& forces, const LongStep& step, const Vec3Field& position);

  /// g less the rate's tensions in N, 0 on pins. Updates the force model to the positions.
  void find_residual(const ClothSystem& system, ForceModel& forces, const LongStep& step,
                     const Vec3Field& position, Vec3Field& residual);

  const Vec3Field& integrated_force() const { return integrated_force_; }  ///< N, f(x*, v*)
  const Vec3Field& force() const { return force_; }  ///< N, of the last residual: f and the tensions

  /// A at the positions, in kg, with the tensions' part, for constraints to be added to its blocks.
  Linearisation& linearise(const ClothSystem& system, ForceModel& forces, const LongStep& step,
                           const Vec3Field& position);

  /// A solution = right_hand_side; false where that was not found. `position`: that of linearise().
  bool solve(const ClothSystem& system, const Vec3Field& position, const Vec3Field& right_hand_side,
             Vec3Field& solution);

 private:
  Vec3Field integrated_position_, integrated_force_;  ///< m, N
  Vec3Field velocity_, force_;                        ///< m/s, N, of the last residual
  LinearMethod method_ = LinearMethod::cholesky;
  Linearisation linearisation_;
  CholeskyFactors factors_;
  BlockJacobi jacobi_;
  MultigridSolver multigrid_;
  ConjugateGradients gradients_;
};

}  // namespace cloth
