// The matrix of an implicit step of a crumpled cloth, and dense forms of what solves with it.
#pragma once

#include <Eigen/Core>

#include "integrators/implicit/linear_solver.h"
#include "integrators/implicit/multigrid_solver.h"
#include "support/direct_run.h"

namespace cloth::test {

/// Crumpled by `deviation` in m, with the clamped and the exact matrix of a step h in s.
struct LinearisedCloth {
  LinearisedCloth(const Scene& scene, double h, double deviation);
  void linearise(bool clamps, Linearisation& to);
  bool prepare(MultigridSolver& solver) const {
    return solver.prepare(run.system, clamped, run.state.position);
  }
  std::size_t size() const { return run.state.position.size(); }
  /// A right-hand side, zero on pins.
  Vec3Field residual() const;
  /// Of the clamped matrix, with one on the diagonal of pins.
  Eigen::MatrixXd matrix() const;
  Eigen::MatrixXd matrix_of(const LinearMap& map) const;

  DirectRun run;
  double step;
  Linearisation clamped, exact;
};

/// Of the clamped matrix A, and a cycle, B: B is symmetric, and the norm of I - B A is less than `most` in
/// A's.
void expect_a_cycle_that_reduces_every_error(const Scene& scene, double h, double deviation, double most);

/// Conjugate gradients with the cycle come to the factors' solution to 1e-8.
void expect_the_solution_of_factors(const Scene& scene, double h, double deviation, int most_iterations);

/// Of conjugate gradients with the cycle; -1: it could not be made.
int iterations_to_a_thousandth(const Scene& scene, double h, double deviation);

}  // namespace cloth::test
