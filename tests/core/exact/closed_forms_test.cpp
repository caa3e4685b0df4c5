// Catenary, shear tests and swings against balance of forces, work and their own inverses.
#include <gtest/gtest.h>

#include <cmath>

#include "exact/catenary.h"
#include "exact/shear_frame.h"
#include "exact/swing.h"

namespace cloth::test::exact_closed_forms_test {
namespace {

using namespace cloth::exact;

constexpr ShearLaw laws[] = {ShearLaw::angle, ShearLaw::green, ShearLaw::diagonals};

TEST(ACatenary, IsAHyperbolicCosine) {
  const Catenary found = catenary(4 * std::sinh(1), 4, 0, 0.3, 9.81);
  EXPECT_NEAR(found.parameter, 2, 1e-12);
  EXPECT_NEAR(found.sag, 2 * (std::cosh(1) - 1), 1e-12);
  EXPECT_NEAR(found.horizontal, 0.3 * 9.81 * 2, 1e-11);
  EXPECT_NEAR(found.left_tension, found.horizontal * std::cosh(1), 1e-11);
}

TEST(ACatenary, BetweenSupportsOfAnyHeightsCarriesItsWeight) {
  for (const double rise : {-0.8, 0.0, 0.5})
    for (const double length : {1.3, 1.5, 4.0}) {
      const Catenary found = catenary(length, 1, rise, 0.2, 10);
      const ElasticaPoint &left = found.points.front(), &right = found.points.back();
      EXPECT_NEAR(right.x, 1, 1e-12);
      EXPECT_NEAR(right.y, rise, 1e-12);
      const double lifts =
          -found.right_tension * std::cos(right.angle) + found.left_tension * std::cos(left.angle);
      EXPECT_NEAR(lifts, 0.2 * 10 * length, 1e-11);
      EXPECT_NEAR(found.left_tension * std::sin(left.angle), found.horizontal, 1e-11);
      EXPECT_NEAR(found.right_tension * std::sin(right.angle), found.horizontal, 1e-11);
    }
}

TEST(ACatenary, HasTheSagAndTheLowestPointOfItsOwnPoints) {
  const Catenary found = catenary(1.6, 1, 0.4, 1, 1, 4000);
  double sag = 0, lowest = 0, length = 0;
  for (std::size_t k = 0; k < found.points.size(); ++k) {
    const ElasticaPoint& p = found.points[k];
    sag = std::max(sag, 0.4 * p.x - p.y);
    lowest = std::min(lowest, p.y);
    if (k > 0) length += std::hypot(p.x - found.points[k - 1].x, p.y - found.points[k - 1].y);
  }
  EXPECT_NEAR(sag, found.sag, 1e-6);
  EXPECT_NEAR(lowest, found.lowest_y, 1e-6);
  EXPECT_NEAR(length, 1.6, 1e-6);
}

TEST(ShearLaws, AgreeForSmallAnglesAndHaveTheirMoments) {
  for (const ShearLaw law : laws) {
    EXPECT_NEAR(shear_energy(law, 30, 0.01), 30 * 0.01 * 0.01 / 2, 1e-4 * 30 * 0.01 * 0.01);
    const double slope = (shear_energy(law, 30, 0.6 + 1e-5) - shear_energy(law, 30, 0.6 - 1e-5)) / 2e-5;
    EXPECT_NEAR(shear_moment(law, 30, 0.6), slope, 1e-7);
  }
}

TEST(ThePictureFrame, StoresTheWorkThatIsDone) {
  constexpr double c66 = 30, side = 0.2, angle = 0.8;
  for (const ShearLaw law : laws) {
    double work = 0;
    for (int k = 0; k < 4000; ++k) {
      const double from = angle * k / 4000, to = angle * (k + 1) / 4000;
      work += picture_frame_force(law, c66, side, (from + to) / 2) *
              (picture_frame_extension(side, to) - picture_frame_extension(side, from));
    }
    EXPECT_NEAR(work / (side * side * shear_energy(law, c66, angle)), 1, 1e-6);
    const double force = picture_frame_force(law, c66, side, angle);
    EXPECT_NEAR(shear_stiffness_of_frame(law, force, side, angle), c66, 1e-12);
  }
  EXPECT_NEAR(picture_frame_shear_force(ShearLaw::green, c66, side, angle), c66 * side * std::sin(angle),
              1e-12);
}

TEST(TheDiagonalsOfSquareCells, AreTwoSpringsOfStiffnessC66) {
  constexpr double k = 7, a = 0.01, gamma = 0.5;
  double energy = 0;
  for (const double sign : {1.0, -1.0}) {
    const double length = a * std::hypot(1 + sign * std::sin(gamma), std::cos(gamma));
    energy += k / 2 * std::pow(length - a * std::sqrt(2), 2);
  }
  EXPECT_NEAR(energy / (a * a), shear_energy(ShearLaw::diagonals, k, gamma), 1e-9);
}

TEST(BiasExtension, StoresTheWorkOfItsZonesAndGivesBackItsAngle) {
  constexpr double c66 = 30, length = 0.3, width = 0.1, angle = 0.7;
  EXPECT_NEAR(bias_shear_angle(length, width, bias_extension(length, width, angle)), angle, 1e-12);
  for (const ShearLaw law : laws) {
    double work = 0;
    for (int k = 0; k < 4000; ++k) {
      const double from = angle * k / 4000, to = angle * (k + 1) / 4000;
      work += bias_extension_force(law, c66, length, width, (from + to) / 2) *
              (bias_extension(length, width, to) - bias_extension(length, width, from));
    }
    const double stored = width * (length - 1.5 * width) * shear_energy(law, c66, angle) +
                          width * width * shear_energy(law, c66, angle / 2);
    EXPECT_NEAR(work / stored, 1, 1e-6);
  }
}

TEST(AHangingChain, SwingsAsManyPendulumsInARowDo) {
  // n equal masses on light threads: T x = w^2 x with tensions from below; the first mode by inverse
  // iteration, x <- sum over threads of (sum of x below)/(tension).
  constexpr int n = 4000;
  std::vector<double> x(n, 1);
  double square = 0;
  for (int sweep = 0; sweep < 30; ++sweep) {
    double below = 0;
    std::vector<double> lean(n);
    for (int k = n - 1; k >= 0; --k) lean[k] = (below += x[k]) / (n - k);
    double offset = 0;
    const double before = x.back();
    for (int k = 0; k < n; ++k) x[k] = offset += lean[k] / n;
    square = before / x.back();
    for (double& value : x) value /= x.back();
    x.back() = 1;
  }
  EXPECT_NEAR(std::sqrt(square), hanging_chain_frequency(1, 1), 1e-3);
  EXPECT_NEAR(hanging_chain_frequency(0.25, 9.81), 2.404825557695773 / 2 * std::sqrt(9.81 / 0.25), 1e-12);
}

TEST(ADampedSwing, LosesItsDecrementInEachPeriod) {
  const DampedSwing swing = damped_swing(5, 0.4);
  EXPECT_NEAR(swing.frequency, std::sqrt(25 - 0.04), 1e-14);
  const double period = 2 * pi / swing.frequency, steps = 20000, h = period / steps;
  double x = 1, v = -0.2;  // of the decaying cosine
  for (int k = 0; k < steps; ++k) {
    const double middle_x = x + h / 2 * v, middle_v = v + h / 2 * (-25 * x - 0.4 * v);
    x += h * middle_v;
    v += h * (-25 * middle_x - 0.4 * middle_v);
  }
  EXPECT_NEAR(-std::log(x), swing.decrement, 1e-6);
  EXPECT_NEAR(mass_damping_of(1, std::exp(-3 * swing.decrement), 3, swing.frequency), 0.4, 1e-13);
}

}  // namespace
}  // namespace cloth::test::exact_closed_forms_test
