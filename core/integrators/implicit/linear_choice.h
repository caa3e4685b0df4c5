// How the linear systems of an implicit step are solved. Factors cost the same for every stiffness; conjugate
// gradients cost more the further the step reaches beyond the fastest oscillation. The choice is a fixed rule
// from costs as measured once, so that a scene always takes the same way; docs/methods/implicit-euler.md has
// the measurements.
#pragma once

#include "forces/linearisation.h"

namespace cloth {

enum class LinearMethod { cholesky, conjugate_gradients };

/// "factors" or "conjugate gradients"
const char* name_of(LinearMethod method);

/// Estimates of one solve of A x = b, from the costs of the machine that was measured on.
struct LinearChoice {
  LinearMethod method = LinearMethod::cholesky;  ///< the cheaper one
  double factors = 0;                            ///< s
  double gradients = 0;                          ///< s
  double iterations = 0;                         ///< of conjugate gradients
};
LinearChoice choose_linear_method(const ClothSystem& system, const LinearisationWeights& weights);

}  // namespace cloth
