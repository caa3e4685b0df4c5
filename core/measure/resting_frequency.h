// The fastest oscillation of a cloth of any shape, without iterating.
#pragma once

#include "cloth/cloth_system.h"

namespace cloth {

/// An upper bound in 1/s of the circular frequencies of the cloth at rest, without its pins. At rest the
/// springs' stiffness is B^T D B, one row of B for each spring e with direction d_e; M^-1 B^T D B has the
/// eigenvalues of D B M^-1 B^T but for zeros, and of that Gershgorin's theorem (1931) gives
///
///     omega^2 <= max_e sum_f k_f |d_e . d_f| sum of 1/m over the particles that e and f share.
///
/// Exact for a square grid of structural springs alone; 15 % too high, as a frequency 7 %, for equilateral
/// triangles. Springs without length count whole.
double resting_frequency(const ClothSystem& system);

}  // namespace cloth
