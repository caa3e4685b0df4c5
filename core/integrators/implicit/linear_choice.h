// Chooses how the linear systems of an implicit step are solved. The cost of a sparse Cholesky factorisation
// does not depend on the stiffness; the cost of conjugate gradients grows with the ratio of the step to the
// period of the fastest oscillation. The rule uses costs measured once on one machine, so that the same scene
// is solved in the same way everywhere; docs/methods/implicit-euler.md has the measurements.
#pragma once

#include <optional>

#include "forces/linearisation.h"

namespace cloth {

/// Conjugate gradients with the inverses of the diagonal's blocks as preconditioner, or with a cycle
/// of multigrid (multigrid_solver.h).
enum class LinearMethod { cholesky, conjugate_gradients, multigrid };

/// "factors", "conjugate gradients" or "multigrid"
const char* name_of(LinearMethod method);

/// Estimates of one solve of A x = b, from the costs of the machine that was measured on; that of conjugate
/// gradients half as much again, since Newton's method takes more iterations with them.
struct LinearChoice {
  LinearMethod method = LinearMethod::cholesky;  ///< the cheapest one
  double factors = 0;                            ///< s
  double gradients = 0;                          ///< s
  double iterations = 0;                         ///< of conjugate gradients
  std::optional<double> multigrid = {};  ///< s; none: a grid that is too small, or too stiff for its precision
};
LinearChoice choose_linear_method(const ClothSystem& system, const LinearisationWeights& weights);

}  // namespace cloth
