// A spring pendulum that is exactly linear: two particles below two pins move up and down together, so that
// each vertical spring keeps its direction and the horizontal ones their length.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <map>
#include <numbers>

#include "integrators/registry.h"
#include "support/direct_run.h"
#include "support/scenes.h"
#include "support/test_names.h"

namespace cloth::test::oscillator_test {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr double stiffness = 40, mass = 0.1, spacing = 0.5;
const double omega = std::sqrt(stiffness / mass);

Scene vertical_pendulum(double damping_ratio = 0) {
  Scene scene = bare_sheet(2, 2, spacing, mass);
  scene.cloth.pins = {NamedPin::top_edge};
  scene.springs = only(SpringFamily::structural, stiffness);
  if (damping_ratio > 0) scene.damping = 2 * damping_ratio * omega * mass;
  return scene;
}

class Oscillator {
 public:
  explicit Oscillator(const std::string& method, double damping_ratio = 0)
      : run_(vertical_pendulum(damping_ratio), method) {
    for (const std::size_t i : {2u, 3u}) run_.state.position.add(i, {0, amplitude, 0});
  }
  void advance(int steps, double step) { run_.advance(steps, step); }
  double x() const { return (run_.state.position[2].y() + spacing) / amplitude; }
  double v() const { return run_.state.velocity[2].y() / amplitude; }
  double across() const {
    return std::abs(run_.state.position[2].x()) + std::abs(run_.state.position[2].z());
  }

 private:
  static constexpr double amplitude = 0.005;  // m; explicit Euler makes it 23 times as much
  DirectRun run_;
};

/// What a method adds to the exact motion: exp((-damping + i delay) omega T), leading coefficients in w =
/// omega h.
struct Coefficients {
  double frequency = 0, damping = 0;
};

Coefficients predicted(const std::string& method, double w) {
  const double w2 = w * w, w5 = std::pow(w, 5);
  const std::map<std::string, Coefficients> table{{"explicit-euler", {-w2 / 3, -w / 2}},
                                                  {"semi-implicit-euler", {w2 / 24, 0}},
                                                  {"verlet", {w2 / 24, 0}},
                                                  {"rk4", {-w2 * w2 / 120, w5 / 144}},
                                                  {"dormand-prince", {w * w5 / 2100, w5 / 3600}},
                                                  {"implicit-euler", {-w2 / 3, w / 2}},
                                                  {"implicit-midpoint", {-w2 / 12, 0}},
                                                  {"bdf2", {-w2 / 3, w * w2 / 4}},
                                                  {"projective", {-w2 / 3, w / 2}},
                                                  {"xpbd", {-w2 / 3, w / 2}},
                                                  {"vbd", {-w2 / 3, w / 2}}};
  return table.at(method);
}

/// Distance in phase space from the exact motion after ten periods at w = 0.1.
const std::map<std::string, double> error_at_a_tenth{
    {"explicit-euler", 22}, {"semi-implicit-euler", 2.62e-2}, {"verlet", 2.62e-2},
    {"rk4", 5.25e-5},       {"dormand-prince", 1.76e-7},      {"implicit-euler", 0.957},
    {"bdf2", 2.05e-1},      {"implicit-midpoint", 5.23e-2},   {"projective", 0.957},
    {"xpbd", 0.957},         {"vbd", 0.957}};

class PhaseError : public ::testing::TestWithParam<std::string> {};

TEST_P(PhaseError, IsWithinATenthOfItsLeadingCoefficients) {
  for (const int steps_per_period : {63, 126, 252}) {
    const double w = 2 * pi / steps_per_period, periods = 10;
    Oscillator oscillator(GetParam());
    oscillator.advance(10 * steps_per_period, w / omega);
    const Complex measured = std::log(Complex(oscillator.x(), -oscillator.v() / omega));  // exact: 0
    const Coefficients c = predicted(GetParam(), w);
    const double turned = 2 * pi * periods;
    const Complex expected(-c.damping * turned, c.frequency * turned);
    // Rounding of positions of 0.5 m, seen from an amplitude of 5 mm.
    const double rounding = 1e-14 * std::sqrt(turned / w);
    const double tenth_of_delay = 0.1 * std::abs(expected.imag());
    EXPECT_NEAR(measured.imag(), expected.imag(), tenth_of_delay + rounding) << GetParam() << " w = " << w;
    const double tenth_of_loss = c.damping != 0 ? 0.1 * std::abs(expected.real()) : tenth_of_delay;
    EXPECT_NEAR(measured.real(), expected.real(), tenth_of_loss + rounding) << GetParam() << " w = " << w;
    const double error = std::abs(std::exp(measured) - 1.0),
                 predicted_error = std::abs(std::exp(expected) - 1.0);
    EXPECT_NEAR(error, predicted_error, 0.1 * predicted_error + rounding) << GetParam() << " w = " << w;
    EXPECT_LE(oscillator.across(), 1e-12);
  }
}

TEST_P(PhaseError, AtATenthIsThatOfTheTable) {  // ten periods at w = 0.1
  Oscillator oscillator(GetParam());
  oscillator.advance(630, 2 * pi / 63 / omega);
  const double error = std::abs(Complex(oscillator.x() - 1, -oscillator.v() / omega));
  EXPECT_NEAR(error / error_at_a_tenth.at(GetParam()), 1, 0.1);
}

TEST_P(PhaseError, OfADampedOscillationVanishesAtTheMethodsOrder) {
  const double ratio = 0.1, time = 10 / omega;
  const auto error = [&](int steps) {
    Oscillator oscillator(GetParam(), ratio);
    oscillator.advance(steps, time / steps);
    const double wd = omega * std::sqrt(1 - ratio * ratio), decay = std::exp(-ratio * omega * time);
    const double x = decay * (std::cos(wd * time) + ratio * omega / wd * std::sin(wd * time));
    const double v = -decay * omega * omega / wd * std::sin(wd * time);
    return std::hypot(oscillator.x() - x, (oscillator.v() - v) / omega);
  };
  const int order = facts_of(GetParam()).order, steps = order > 4 ? 80 : 800;  // above rounding
  EXPECT_NEAR(std::log2(error(steps) / error(2 * steps)), order, 0.1) << GetParam();
}

INSTANTIATE_TEST_SUITE_P(Of, PhaseError, ::testing::ValuesIn(integrator_names()), test_name);

TEST(SemiImplicitEuler, KeepsItsModifiedEnergyAndBoundsTheTrueOneByIt) {
  for (const double w : {0.1, 0.5, 1.0, 1.9}) {
    Oscillator oscillator("semi-implicit-euler");
    const double h = w / omega;
    const auto energy = [&] {
      return 0.5 * std::pow(oscillator.v(), 2) + 0.5 * std::pow(omega * oscillator.x(), 2);
    };
    const auto modified = [&] {
      return energy() - 0.5 * h * omega * omega * oscillator.x() * oscillator.v();
    };
    const double first = modified();
    for (int n = 0; n < 2000; ++n) {
      oscillator.advance(1, h);
      ASSERT_NEAR(modified() / first, 1, 1e-11) << "w = " << w;
      ASSERT_GE(energy() / first, 1 / (1 + w / 2) - 1e-11) << "w = " << w;
      ASSERT_LE(energy() / first, 1 / (1 - w / 2) + 1e-11) << "w = " << w;
    }
  }
}

TEST(Verlet, KeepsItsModifiedEnergyAndBoundsTheTrueOneByIt) {
  for (const double w : {0.1, 0.5, 1.0, 1.9}) {
    Oscillator oscillator("verlet");
    const double h = w / omega;
    const auto kinetic = [&] { return 0.5 * std::pow(oscillator.v(), 2); };
    const auto elastic = [&] { return 0.5 * std::pow(omega * oscillator.x(), 2); };
    const auto modified = [&] { return kinetic() + elastic() * (1 - w * w / 4); };
    const double first = modified();
    for (int n = 0; n < 2000; ++n) {
      oscillator.advance(1, h);
      ASSERT_NEAR(modified() / first, 1, 1e-11) << "w = " << w;
      ASSERT_GE((kinetic() + elastic()) / first, 1 - 1e-11) << "w = " << w;
      ASSERT_LE((kinetic() + elastic()) / first, 1 / (1 - w * w / 4) + 1e-11) << "w = " << w;
    }
  }
}

TEST(Rk4, MultipliesTheLinearOscillatorByItsStabilityPolynomial) {
  for (const double ratio : {0.0, 0.3}) {
    const double w = 0.7, h = w / omega;
    Oscillator oscillator("rk4", ratio);
    Eigen::Matrix2d a;
    a << 0, 1, -omega * omega, -2 * ratio * omega;
    const Eigen::Matrix2d z = h * a, one = Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d factor = one + z * (one + z / 2 * (one + z / 3 * (one + z / 4)));
    Eigen::Vector2d expected(1, 0);
    for (int n = 0; n < 100; ++n) {
      oscillator.advance(1, h);
      expected = factor * expected;
      ASSERT_NEAR(oscillator.x(), expected[0], 1e-12);
      ASSERT_NEAR(oscillator.v(), expected[1], 1e-12 * omega);
    }
  }
}

TEST(DormandPrince, MultipliesTheLinearOscillatorByItsStabilityPolynomial) {
  for (const double ratio : {0.0, 0.3}) {
    const double w = 0.7, h = w / omega;
    Oscillator oscillator("dormand-prince", ratio);
    Eigen::Matrix2d a;
    a << 0, 1, -omega * omega, -2 * ratio * omega;
    const Eigen::Matrix2d z = h * a, one = Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d factor =
        one + z * (one + z / 2 * (one + z / 3 * (one + z / 4 * (one + z / 5 * (one + z / 5)))));
    Eigen::Vector2d expected(1, 0);
    for (int n = 0; n < 100; ++n) {
      oscillator.advance(1, h);
      expected = factor * expected;
      ASSERT_NEAR(oscillator.x(), expected[0], 1e-12);
      ASSERT_NEAR(oscillator.v(), expected[1], 1e-12 * omega);
    }
  }
}

TEST(ExplicitEuler, MultipliesTheLinearOscillatorByItsStabilityPolynomial) {
  const double h = 0.3 / omega;
  Oscillator oscillator("explicit-euler");
  Complex expected(1, 0);
  for (int n = 0; n < 50; ++n) {
    oscillator.advance(1, h);
    expected *= Complex(1, h * omega);
    ASSERT_NEAR(oscillator.x(), expected.real(), 1e-12 * std::abs(expected));
    ASSERT_NEAR(oscillator.v() / omega, -expected.imag(), 1e-12 * std::abs(expected));
  }
}

}  // namespace
}  // namespace cloth::test::oscillator_test
