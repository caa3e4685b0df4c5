// The frequencies of a cloth in any shape, with its masses and pins. Springs only, without air, the hand and
// contact.
#pragma once

#include "cloth/cloth_system.h"

namespace cloth {

/// Of M^-1 K, K the second derivatives of the springs' energy; every eigenvalue is the omega^2 of a motion.
/// A Lanczos estimate lies between the true extremes: `largest` is never too large, `smallest` never too
/// small.
struct Spectrum {
  double largest = 0;            ///< 1/s^2
  double smallest = 0;           ///< 1/s^2; below 0: the cloth buckles at the rate sqrt(-smallest)
  double largest_residual = 0;   ///< 1/s^2: some eigenvalue lies this near to `largest`
  double smallest_residual = 0;  ///< 1/s^2, likewise; slow to converge where many motions have no stiffness
  int iterations = 0;

  double largest_frequency() const;  ///< omega_max in 1/s
};

/// The extreme Ritz values of a Lanczos iteration and their residuals: eigenvalues of the tridiagonal matrix
/// of `diagonal` and of the `coupling` of neighbours; `next` is the coupling to the vector that would follow.
/// 1/s^2
Spectrum ritz_extremes(const std::vector<double>& diagonal, const std::vector<double>& coupling, double next);

/// When to stop: after so many iterations, or when the residual of `largest` relative to it is small. On
/// square grids at rest 60 iterations give the largest frequency to 2e-4 (40 x 40) or better (fewer
/// particles).
struct LanczosLimits {
  int iterations = 60;
  double tolerance = 1e-6;
};

/// Lanczos iteration with full reorthogonalisation (Paige 1971; Golub & Van Loan, Matrix Computations, 10.3)
/// from a fixed start: the same bits for the same state. Pinned particles do not move. A spring of length 0
/// has no direction and counts k in every one. Cost: about `iterations` force evaluations and 4 iterations^2
/// additions of vectors; memory: `iterations` vectors.
Spectrum measure_spectrum(const ClothSystem& system, const Vec3Field& position,
                          const LanczosLimits& limits = {});

/// An upper bound in 1/s of this system's frequencies in any configuration, any stretch. No spring is stiffer
/// than k in any direction, so that the bound is the root of the largest eigenvalue of M^-1/2 L M^-1/2, L the
/// scalar graph Laplacian of the springs: by Lanczos iteration, its residual added, and never above what
/// Gershgorin's theorem gives, max_i (1/m_i) sum_j b_ij, b = 2 k for a spring to a free particle and k to a
/// pin. Cost: at most 160 passes over the springs.
double guaranteed_frequency(const ClothSystem& system);

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
