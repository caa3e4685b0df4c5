// What one step of a method does to the oscillator x'' = -omega^2 x - c x', exactly.
//
// Every method here is linear on it: a step multiplies by a matrix that depends on w = omega h and on the
// damping ratio zeta = c / (2 omega) alone. Its eigenvalues say everything: the method is stable where none
// exceeds 1 in modulus, and their logarithm is the frequency and damping that the computed motion has.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

namespace cloth {

/// The matrix of one step: 2 x 2 on (x, h v); for bdf2 the 4 x 4 companion on (x', h v', x, h v), the new and
/// the old state. Precondition of all here: `method` is one of integrator_names().
Eigen::MatrixXd amplification_matrix(const std::string& method, double w, double zeta);

/// Its spectral radius. Accurate to some 1e-15 but near a double eigenvalue (Verlet at w = 2), where it is
/// the root of that.
double amplification(const std::string& method, double w, double zeta);

/// Errors of a computed oscillation: x = A exp(-(zeta + damping) omega t) cos((1 + frequency) omega_d t +
/// phi) for the exact omega_d = omega sqrt(1 - zeta^2).
struct OscillatorError {
  double frequency = 0;  ///< relative
  double damping = 0;    ///< added to zeta; positive: the motion dies out too soon
};

/// From the principal eigenvalue, the one nearest to that of the exact motion; its rounding is some 1e-15 /
/// w. Precondition: 0 < w, 0 <= zeta < 1, below the method's limit.
OscillatorError oscillator_error(const std::string& method, double w, double zeta = 0);

/// The largest step h in s up to which no eigenvalue exceeds 1 + 1e-14 for x'' = -omega^2 x - c x' (1/s; not
/// both 0), found by scanning outwards and halving the interval of the first crossing: what lies beyond a
/// first unstable interval is not counted. Infinity if none does up to |lambda h| = 1e6. Where the growth
/// begins as a power of h the threshold shows: explicit Euler undamped gives some 1e-7 / omega instead of 0.
/// The scan ends at `at_most`, in s, and gives infinity where the limit is longer by more than its
/// resolution.
double scanned_limit(const std::string& method, double omega, double c,
                     double at_most = std::numeric_limits<double>::infinity());

}  // namespace cloth
