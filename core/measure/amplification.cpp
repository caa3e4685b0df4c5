#include "measure/amplification.h"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <complex>
#include <limits>

#include "scene/method_facts.h"

namespace cloth {
namespace {

// Legend: z an eigenvalue of the motion times h; w^2 = omega^2 h^2; d = c h; r an eigenvalue of the step.

using Complex = std::complex<double>;
using Eigen::Matrix2d;

/// The two eigenvalues, times h, of x'' = -omega^2 x - c x'; `fast` is the larger one in modulus.
struct Motion {
  Complex fast, slow;
  double stiffness() const { return (fast * slow).real(); }  // w^2
  double damping() const { return -(fast + slow).real(); }   // d
};

Motion motion_of(double w_squared, double d) {
  const double discriminant = 0.25 * d * d - w_squared;
  if (discriminant < 0) {
    const Complex fast(-0.5 * d, std::sqrt(-discriminant));
    return {fast, std::conj(fast)};
  }
  const double fast = -(0.5 * d + std::sqrt(discriminant));
  return {fast, fast < 0 ? w_squared / fast : 0};
}

Motion scaled(double factor, const Motion& motion) {
  return {factor * motion.fast, factor * motion.slow};
}

Complex stability_function(const OscillatorStep& formula, Complex z) {
  Complex value = 1;
  for (auto divisor = formula.divisors.rbegin(); divisor != formula.divisors.rend(); ++divisor)
    value = 1.0 + z / *divisor * value;
  return formula.implicit == 0 ? value : value / (1.0 - formula.implicit * z);
}

Matrix2d runge_kutta_matrix(const OscillatorStep& formula, const Matrix2d& z) {
  Matrix2d value = Matrix2d::Identity();
  for (auto divisor = formula.divisors.rbegin(); divisor != formula.divisors.rend(); ++divisor)
    value = Matrix2d::Identity() + z / *divisor * value;
  return (Matrix2d::Identity() - formula.implicit * z).inverse() * value;
}

/// Kick with the damping of the old velocity, then drift.
Matrix2d semi_implicit_euler_matrix(double w_squared, double d) {
  const Eigen::RowVector2d velocity(-w_squared, 1 - d);
  Matrix2d step;
  step << Eigen::RowVector2d(1, 0) + velocity, velocity;
  return step;
}

/// Half a kick, drift, half a kick that is implicit in the damping.
Matrix2d verlet_matrix(double w_squared, double d) {
  const Eigen::RowVector2d half(-0.5 * w_squared, 1 - 0.5 * d);
  const Eigen::RowVector2d position = Eigen::RowVector2d(1, 0) + half;
  Matrix2d step;
  step << position, (half - 0.5 * w_squared * position) / (1 + 0.5 * d);
  return step;
}

/// y' = (4 y - y_old) / 3 + 2/3 h f(y')
Eigen::Matrix4d bdf2_matrix(const Matrix2d& z) {
  const Matrix2d solve = (3 * Matrix2d::Identity() - 2 * z).inverse();
  Eigen::Matrix4d step;
  step << 4 * solve, -solve, Matrix2d::Identity(), Matrix2d::Zero();
  return step;
}

/// Both roots of a r^2 + b r + c = 0, the larger one first computed without cancellation.
std::array<Complex, 2> roots(Complex a, Complex b, Complex c) {
  const Complex root = std::sqrt(b * b - 4.0 * a * c);
  const Complex sum = -0.5 * (b + (std::real(std::conj(b) * root) >= 0 ? root : -root));
  if (sum == 0.0) return {0.0, 0.0};
  return {sum / a, c / sum};
}

std::array<Complex, 2> eigenvalues_of(const Matrix2d& m) {
  return roots(1, -m.trace(), m.determinant());
}

/// At most four, without memory of its own: limits are scanned through millions of them.
using Eigenvalues = Eigen::Matrix<Complex, Eigen::Dynamic, 1, 0, 4, 1>;

Eigenvalues eigenvalues(const OscillatorStep& formula, const Motion& z) {
  std::array<Complex, 2> r{};
  switch (formula.family) {
    case OscillatorStep::Family::runge_kutta: {
      const Complex fast = stability_function(formula, z.fast);
      return Eigenvalues{
          {fast, z.slow == std::conj(z.fast) ? std::conj(fast) : stability_function(formula, z.slow)}};
    }
    case OscillatorStep::Family::bdf2: {
      r = roots(3.0 - 2.0 * z.fast, -4, 1);
      const auto slow = roots(3.0 - 2.0 * z.slow, -4, 1);
      return Eigenvalues{{r[0], r[1], slow[0], slow[1]}};
    }
    case OscillatorStep::Family::semi_implicit_euler:
      r = eigenvalues_of(semi_implicit_euler_matrix(z.stiffness(), z.damping()));
      break;
    case OscillatorStep::Family::verlet:
      r = eigenvalues_of(verlet_matrix(z.stiffness(), z.damping()));
      break;
  }
  return Eigenvalues{{r[0], r[1]}};
}

double spectral_radius(const OscillatorStep& formula, const Motion& z) {
  double largest = 0;
  for (const Complex& r : eigenvalues(formula, z)) largest = std::max(largest, std::abs(r));
  return largest;
}

}  // namespace

Eigen::MatrixXd amplification_matrix(const std::string& method, double w, double zeta) {
  const OscillatorStep& formula = facts_of(method).oscillator;
  const double d = 2 * zeta * w;
  Matrix2d z;
  z << 0, 1, -w * w, -d;
  switch (formula.family) {
    case OscillatorStep::Family::semi_implicit_euler:
      return semi_implicit_euler_matrix(w * w, d);
    case OscillatorStep::Family::verlet:
      return verlet_matrix(w * w, d);
    case OscillatorStep::Family::bdf2:
      return bdf2_matrix(z);
    case OscillatorStep::Family::runge_kutta:
      break;
  }
  return runge_kutta_matrix(formula, z);
}

double amplification(const std::string& method, double w, double zeta) {
  return spectral_radius(facts_of(method).oscillator, motion_of(w * w, 2 * zeta * w));
}

OscillatorError oscillator_error(const std::string& method, double w, double zeta) {
  const Motion z = motion_of(w * w, 2 * zeta * w);
  const Complex exact = std::exp(z.fast);
  const Eigenvalues r = eigenvalues(facts_of(method).oscillator, z);
  const Complex principal = *std::min_element(r.begin(), r.end(), [&](const Complex& a, const Complex& b) {
    return std::abs(a - exact) < std::abs(b - exact);
  });
  const Complex drift = std::log(principal / exact);
  return {.frequency = drift.imag() / z.fast.imag(), .damping = -drift.real() / w};
}

double scanned_limit(const std::string& method, double omega, double c, double at_most) {
  constexpr double resolution = 0.01;         // in |z|, up to `fine`; relative beyond
  constexpr double fine = 4, farthest = 1e6;  // every explicit limit that is not a ratio lies before
  // Eigenvalues of modulus 1 come out within a few roundings of 1, and on the imaginary axis Runge-Kutta
  // methods stay within rounding of it for small z (|R|^2 = 1 - z^6/72 + ... for rk4), so 1 itself is no
  // threshold. The slowest growth in use, Dormand-Prince's beyond its limit, passes 1e-14 within 1e-10 of
  // that limit.
  constexpr double threshold = 1 + 1e-14;
  const OscillatorStep& formula = facts_of(method).oscillator;
  const Motion motion = motion_of(omega * omega, c);
  const double modulus_of_motion = std::abs(motion.fast);
  assert(modulus_of_motion > 0);
  const Motion unit{motion.fast / modulus_of_motion, motion.slow / modulus_of_motion};
  const auto stable = [&](double modulus) {
    return spectral_radius(formula, scaled(modulus, unit)) <= threshold;
  };
  const double end = at_most * modulus_of_motion;
  double low = 0, high = 0;
  for (double modulus = resolution; low <= end && modulus < farthest;
       modulus = modulus < fine ? modulus + resolution : modulus * (1 + resolution)) {
    if (!stable(modulus)) {
      high = modulus;
      break;
    }
    low = modulus;
  }
  if (high == 0) return std::numeric_limits<double>::infinity();
  for (int halving = 0; halving < 50; ++halving)
    (stable(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  return low / modulus_of_motion;
}

}  // namespace cloth
