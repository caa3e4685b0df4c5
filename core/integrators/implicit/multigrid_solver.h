// Linear systems of an implicit step on a grid by conjugate gradients with a cycle of multigrid
// (sparse/block_multigrid.h).
//
// The cycle is made from the clamped matrix, which is positive definite, and serves the exact one as well,
// also where that is not (forces/linearisation.h).
#pragma once

#include "integrators/implicit/linear_solver.h"
#include "sparse/block_multigrid.h"

namespace cloth {

/// N/m
struct Stiffest {
  double spring = 0;   ///< the stiffest one
  double bending = 0;  ///< on a particle, of the stiffest element
};
Stiffest stiffest_of(const ClothSystem& system);

class MultigridSolver {
 public:
  /// Whether it can be prepared: a grid, whose elements reach two rows and columns at most.
  static bool suits(const ClothSystem& system);
  /// Cubic splines where bending is stiffer than the springs, as in paper.
  static Interpolation interpolation(const ClothSystem& system);

  /// Makes the cycle; false where it could not be made, and nothing can be solved.
  bool prepare(const ClothSystem& system, const Linearisation& clamped);
  /// One cycle.
  void precondition(const Vec3Field& residual, Vec3Field& correction) { cycle_.solve(residual, correction); }

 private:
  bool add_bending(const ClothSystem& system, double weight);
  bool add_sliders(const ClothSystem& system, const Linearisation& matrix);

  BlockMultigrid cycle_;
};

}  // namespace cloth
