// Linear systems of an implicit step on a grid by conjugate gradients with a cycle of multigrid
// (sparse/block_multigrid.h).
//
// The cycle is made from the clamped matrix, which is positive definite, and serves the exact one as well,
// also where that is not (forces/linearisation.h).
#pragma once

#include "integrators/implicit/linear_solver.h"
#include "sparse/block_multigrid.h"

namespace cloth {

class MultigridSolver {
 public:
  /// Whether it can be prepared: a grid, whose elements reach two rows and columns at most.
  static bool suits(const ClothSystem& system);

  /// Makes the cycle; false where it could not be made, and nothing can be solved.
  bool prepare(const ClothSystem& system, const Linearisation& clamped);
  /// One cycle.
  void precondition(const Vec3Field& residual, Vec3Field& correction) { cycle_.solve(residual, correction); }

 private:
  void add_elements(const ClothSystem& system, const Linearisation& matrix);

  BlockMultigrid cycle_;
};

}  // namespace cloth
