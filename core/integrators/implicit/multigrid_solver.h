// Linear systems of an implicit step by conjugate gradients with a cycle of multigrid: on a grid by its rows
// and columns (sparse/block_multigrid.h), on a mesh by smoothed aggregation (sparse/aggregation_multigrid.h).
//
// The cycle is made from the clamped matrix, which is positive definite, and serves the exact one as well,
// also where that is not (forces/linearisation.h).
#pragma once

#include "integrators/implicit/free_blocks.h"
#include "sparse/aggregation_multigrid.h"
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
  /// Whether it can be prepared: a mesh, or a grid of three rows and columns at least.
  static bool suits(const ClothSystem& system);
  /// On a grid: cubic splines where bending is stiffer than the springs, as in paper.
  static Interpolation interpolation(const ClothSystem& system);

  /// Makes the cycle; false where it could not be made, and nothing can be solved. `position`, m: where the
  /// matrix was linearised.
  bool prepare(const ClothSystem& system, const Linearisation& clamped, const Vec3Field& position);
  /// One cycle.
  void precondition(const Vec3Field& residual, Vec3Field& correction);

 private:
  bool prepare_grid(const ClothSystem& system, const Linearisation& clamped);
  bool prepare_mesh(const ClothSystem& system, const Linearisation& clamped, const Vec3Field& position);
  bool add_bending(const ClothSystem& system, double weight);
  bool add_sliders(const ClothSystem& system, const Linearisation& matrix);

  bool is_mesh_ = false;
  BlockMultigrid grid_;
  FreeBlocks blocks_;  ///< of a mesh, and its cycle
  AggregationMultigrid aggregation_;
  std::vector<double> numbers_, corrections_;  ///< scratch
};

}  // namespace cloth
