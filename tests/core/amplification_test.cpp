#include "measure/amplification.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <functional>
#include <map>

#include "scene/method_facts.h"
#include "support/random.h"

namespace cloth::test::amplification_test {
namespace {

/// The limit of |A^n|^(1/n) for n = 1, 2, 4, ...
double spectral_radius(Eigen::MatrixXd matrix) {
  double logarithm = 0;
  for (double part = 1; part > 1e-16; part /= 2) {
    const double norm = matrix.norm();
    if (!(norm > 0)) return 0;
    logarithm += part * std::log(norm);
    matrix = matrix * matrix / (norm * norm);
  }
  return std::exp(logarithm);
}

TEST(Amplification, IsTheSpectralRadiusOfTheMatrix) {
  Random random;
  for (const std::string& method : integrator_names())
    for (int trial = 0; trial < 200; ++trial) {
      const double w = std::pow(10, random.uniform(-2, 2)), zeta = random.uniform(0, 2);
      const double expected = spectral_radius(amplification_matrix(method, w, zeta));
      EXPECT_NEAR(amplification(method, w, zeta), expected, 1e-7 * expected)
          << method << " " << w << " " << zeta;
    }
}

/// One step written down as the method is defined, from x and u = h v; bdf2 apart.
struct Pair {
  double x, u;
};
using Step = std::function<Pair(Pair, double w, double zeta)>;

Pair runge_kutta(Pair y, double w, double zeta, const std::vector<std::vector<double>>& a,
                 const std::vector<double>& b) {
  std::vector<Pair> slopes;
  const auto stage = [&](const std::vector<double>& weights) {
    Pair at = y;
    for (std::size_t k = 0; k < weights.size(); ++k)
      at.x += weights[k] * slopes[k].x, at.u += weights[k] * slopes[k].u;
    return at;
  };
  for (const std::vector<double>& row : a) {
    const Pair at = stage(row);
    slopes.push_back({at.u, -w * w * at.x - 2 * zeta * w * at.u});
  }
  return stage(b);
}

/// Dormand and Prince 1980: the tableau, of whose polynomial the library knows the coefficients alone.
Pair dormand_prince(Pair y, double w, double zeta) {
  return runge_kutta(y, w, zeta,
                     {{},
                      {1.0 / 5},
                      {3.0 / 40, 9.0 / 40},
                      {44.0 / 45, -56.0 / 15, 32.0 / 9},
                      {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                      {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656}},
                     {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84});
}

Pair rk4(Pair y, double w, double zeta) {
  return runge_kutta(y, w, zeta, {{}, {0.5}, {0, 0.5}, {0, 0, 1}}, {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6});
}

Pair explicit_euler(Pair y, double w, double zeta) {
  return runge_kutta(y, w, zeta, {{}}, {1});
}

Pair semi_implicit_euler(Pair y, double w, double zeta) {
  const double u = y.u - w * w * y.x - 2 * zeta * w * y.u;
  return {y.x + u, u};
}

Pair verlet(Pair y, double w, double zeta) {
  const double half = y.u - 0.5 * (w * w * y.x + 2 * zeta * w * y.u);
  const double x = y.x + half;
  return {x, (half - 0.5 * w * w * x) / (1 + zeta * w)};
}

const std::map<std::string, Step> explicit_steps{{"dormand-prince", dormand_prince},
                                                 {"rk4", rk4},
                                                 {"explicit-euler", explicit_euler},
                                                 {"semi-implicit-euler", semi_implicit_euler},
                                                 {"verlet", verlet}};

TEST(AmplificationMatrix, IsTheStepOfTheExplicitMethods) {
  Random random;
  for (const auto& [method, step] : explicit_steps)
    for (int trial = 0; trial < 20; ++trial) {
      const double w = random.uniform(0, 3), zeta = random.uniform(0, 1.5);
      const Eigen::Vector2d start(random.uniform(-1, 1), random.uniform(-1, 1));
      const Pair end = step({start[0], start[1]}, w, zeta);
      const Eigen::Vector2d product = amplification_matrix(method, w, zeta) * start;
      EXPECT_NEAR((product - Eigen::Vector2d(end.x, end.u)).norm(), 0, 1e-12 * (1 + product.norm()))
          << method;
    }
}

/// The equations that the new state solves: their residual at the product of the matrix.
TEST(AmplificationMatrix, SolvesTheEquationsOfTheImplicitMethods) {
  Random random;
  for (int trial = 0; trial < 50; ++trial) {
    const double w = std::pow(10, random.uniform(-1, 1)), zeta = random.uniform(0, 2);
    Eigen::Matrix2d z;
    z << 0, 1, -w * w, -2 * zeta * w;
    const Eigen::Vector2d old(random.uniform(-1, 1), random.uniform(-1, 1));
    const double tolerance = 1e-13 * (1 + z.norm());
    for (const char* method : {"implicit-euler", "projective", "xpbd", "vbd"}) {
      const Eigen::Vector2d now = amplification_matrix(method, w, zeta) * old;
      EXPECT_NEAR((now - old - z * now).norm(), 0, tolerance) << method;
    }
    const Eigen::Vector2d middle = amplification_matrix("implicit-midpoint", w, zeta) * old;
    EXPECT_NEAR((middle - old - z * (middle + old) / 2).norm(), 0, tolerance);

    Eigen::Vector4d both;
    both << old, random.uniform(-1, 1), random.uniform(-1, 1);
    const Eigen::Vector4d next = amplification_matrix("bdf2", w, zeta) * both;
    EXPECT_EQ(next.tail<2>(), old);
    const Eigen::Vector2d now = next.head<2>();
    EXPECT_NEAR((1.5 * now - 2 * old + 0.5 * both.tail<2>() - z * now).norm(), 0, tolerance);
  }
}

TEST(Amplification, OfTheImplicitMethodsIsTheTables) {
  const auto expect = [](const char* method, double at_10, double at_100) {
    EXPECT_NEAR(amplification(method, 10, 0), at_10, at_10 == 0.301 ? 0.51e-3 : 0.51e-4) << method;
    EXPECT_NEAR(amplification(method, 100, 0), at_100, 0.51e-4) << method;
  };
  for (const char* method : {"implicit-euler", "projective", "xpbd", "vbd"}) expect(method, 0.0995, 0.0100);
  expect("bdf2", 0.301, 0.0781);
  expect("implicit-midpoint", 1, 1);
}

TEST(Amplification, OfSemiImplicitEulerGrowsBeyondTwo) {
  EXPECT_NEAR(amplification("semi-implicit-euler", 1.9, 0), 1, 1e-14);
  EXPECT_NEAR(amplification("semi-implicit-euler", 2.1, 0), 1.88, 0.01);
  EXPECT_NEAR(amplification("semi-implicit-euler", 10, 0), 98, 0.1);
}

TEST(Amplification, OfDormandPrinceGrowsSlowlyBeyondItsLimit) {
  EXPECT_NEAR(amplification("dormand-prince", 1.2, 0) - 1, 3.1e-4, 0.06e-4);
  EXPECT_NEAR(amplification("dormand-prince", 1.5, 0) - 1, 3.0e-3, 0.06e-3);
  EXPECT_NEAR(amplification("dormand-prince", 1.9, 0) - 1, 2.2e-2, 0.06e-2);
}

TEST(Amplification, OfTheImplicitMethodsNeverExceedsOne) {
  Random random;
  for (const char* method : {"implicit-euler", "implicit-midpoint", "bdf2", "projective", "xpbd", "vbd"})
    for (int trial = 0; trial < 1000; ++trial) {
      const double w = std::pow(10, random.uniform(-3, 6));
      const double zeta = random.coin() ? 0 : std::pow(10, random.uniform(-4, 2));
      EXPECT_LE(amplification(method, w, zeta), 1 + 1e-14) << method << " " << w << " " << zeta;
    }
}

/// The leading coefficients of the methods' errors: coefficient and power of w.
struct Leading {
  double frequency, frequency_power, damping, damping_power;
};
const std::map<std::string, Leading> table{{"explicit-euler", {-1.0 / 3, 2, -1.0 / 2, 1}},
                                           {"semi-implicit-euler", {1.0 / 24, 2, 0, 1}},
                                           {"verlet", {1.0 / 24, 2, 0, 1}},
                                           {"rk4", {-1.0 / 120, 4, 1.0 / 144, 5}},
                                           {"dormand-prince", {1.0 / 2100, 6, 1.0 / 3600, 5}},
                                           {"implicit-euler", {-1.0 / 3, 2, 1.0 / 2, 1}},
                                           {"implicit-midpoint", {-1.0 / 12, 2, 0, 1}},
                                           {"bdf2", {-1.0 / 3, 2, 1.0 / 4, 3}},
                                           {"projective", {-1.0 / 3, 2, 1.0 / 2, 1}},
                                           {"xpbd", {-1.0 / 3, 2, 1.0 / 2, 1}},
                                           {"vbd", {-1.0 / 3, 2, 1.0 / 2, 1}}};

TEST(OscillatorError, LeadsWithTheTablesCoefficients) {
  ASSERT_EQ(table.size(), integrator_names().size());
  for (const auto& [method, leading] : table)
    for (const double w : {0.1, 0.07, 0.05, 0.02}) {
      const OscillatorError error = oscillator_error(method, w);
      const double frequency = leading.frequency * std::pow(w, leading.frequency_power);
      const double damping = leading.damping * std::pow(w, leading.damping_power);
      const double rounding = 1e-15 / w;
      EXPECT_NEAR(error.frequency, frequency, 0.1 * std::abs(frequency) + rounding) << method << " " << w;
      EXPECT_NEAR(error.damping, damping, 0.1 * std::abs(damping) + rounding) << method << " " << w;
    }
}

TEST(OscillatorError, IsThatOfThePoweredMatrix) {  // many steps, from the matrix alone
  for (const std::string& method : integrator_names())
    for (const double zeta : {0.0, 0.05}) {
      const double w = 0.3;
      const OscillatorError error = oscillator_error(method, w, zeta);
      const double damped = std::sqrt(1 - zeta * zeta);
      const std::complex<double> expected =
          std::exp(std::complex<double>(-(zeta + error.damping) * w, (1 + error.frequency) * damped * w));
      const Eigen::MatrixXd matrix = amplification_matrix(method, w, zeta);
      Eigen::Matrix4cd shifted = Eigen::Matrix4cd::Identity();  // of fixed size: any takes a compiler long
      ASSERT_LE(matrix.rows(), shifted.rows());
      shifted.topLeftCorner(matrix.rows(), matrix.cols()) =
          matrix - expected * Eigen::MatrixXcd::Identity(matrix.rows(), matrix.cols());
      EXPECT_NEAR(std::abs(shifted.determinant()), 0, 1e-13) << method << " " << zeta;
    }
}

}  // namespace
}  // namespace cloth::test::amplification_test
