// The strip under its own weight against its table, the linear beam and the limit of great weight; critical
// loads.
#include "exact/heavy_strip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "exact/bessel_zero.h"

namespace cloth::test::exact_heavy_strip_test {
namespace {

using namespace cloth::exact;

TEST(AHeavyStrip, DroopsAsTheTableSays) {
  const struct {
    double gamma, droop, degrees;
  } table[] = {{0.1, 0.0124996, 0.9548}, {1, 0.1245618, 9.4604},  {2, 0.2466732, 18.4260},
               {5, 0.5857212, 39.9354},  {8, 0.8843303, 53.8650}, {10, 1.066802, 60.3120},
               {20, 1.863930, 76.7478},  {50, 3.705561, 87.4593}, {100, 5.888105, 89.6167},
               {1000, 21.33544, 90.0000}};
  for (const auto& [gamma, droop, degrees] : table) {
    const HeavyCantilever found = heavy_cantilever(gamma);
    EXPECT_NEAR(found.droop_over_width, droop, 6e-7 * std::max(0.1, droop)) << gamma;
    EXPECT_NEAR(found.tip_angle * 180 / pi, degrees, 6e-5) << gamma;
  }
}

TEST(AHeavyStrip, IsALinearBeamUnderLittleWeight) {
  EXPECT_NEAR(heavy_cantilever(1e-3).droop_over_width / 1e-3, 1.0 / 8, 1e-7);
}

TEST(AHeavyStrip, UnderGreatWeightTurnsDownWithinASoliton) {
  // curvature = 2 sqrt(Gamma) sin(angle/2) at the clamp, so that the strip is sqrt(2/Gamma) wide.
  for (const double gamma : {1e4, 1e5, 1e6})
    EXPECT_NEAR(heavy_cantilever(gamma).width * std::sqrt(gamma / 2), 1, 1.2 / std::sqrt(gamma)) << gamma;
}

TEST(AHeavyStrip, KeepsItsLengthAndBalancesItsWeight) {
  for (const double gamma : {1.0, 20.0, 1000.0}) {
    const auto points = heavy_cantilever(gamma).points;
    double moment_at_clamp = 0;
    for (std::size_t k = 1; k < points.size(); ++k) {
      const ElasticaPoint &a = points[k - 1], &b = points[k];
      const double arc = b.arc - a.arc, bent = a.curvature * arc;
      EXPECT_NEAR(std::hypot(b.x - a.x, b.y - a.y) / arc, 1, bent * bent / 20 + 1e-10);
      moment_at_clamp += gamma * arc * (a.x + b.x) / 2;
    }
    EXPECT_NEAR(points.front().angle, rightward, 1e-9);
    EXPECT_EQ(points.front().x, 0);
    EXPECT_EQ(points.back().curvature, 0);
    EXPECT_NEAR(-points.front().curvature / moment_at_clamp, 1, 1e-6) << gamma;
  }
}

TEST(TheCantileverTest, OfAstmFindsTwiceTheBendingLength) {
  EXPECT_NEAR(gamma_of_chord(astm_chord), 8.0042, 5e-5);
  EXPECT_NEAR(1 / astm_bending_length(1), 2.0003, 1e-4);
  EXPECT_NEAR(std::tan(astm_chord), heavy_cantilever(gamma_of_chord(astm_chord)).droop_over_width, 1e-12);
  const double length = 0.1, bending = 1e-5, areal_density = 0.2, gravity = 9.81;
  EXPECT_NEAR(std::pow(length / bending_length(bending, areal_density, gravity), 3),
              load_number(areal_density, gravity, length, bending), 1e-12 * 200);
}

/// The largest eigenvalue's shape by integration: y'' + load(z) y = 0 from the free end, y(0) = 1, y'(0) = 0.
double end_of_linear_mode(double (*load)(double), double scale) {
  constexpr int steps = 20000;
  double y = 1, slope = 0;
  for (int k = 0; k < steps; ++k) {  // Verlet
    const double h = 1.0 / steps, z = k * h;
    slope -= h / 2 * scale * load(z) * y;
    y += h * slope;
    slope -= h / 2 * scale * load(z + h) * y;
  }
  return y;
}

TEST(AStandingStrip, BucklesAtGreenhillsLoad) {
  EXPECT_NEAR(self_buckling_gamma(), 7.837347, 5e-7);
  EXPECT_NEAR(end_of_linear_mode([](double z) { return z; }, self_buckling_gamma()), 0, 1e-7);
}

TEST(AStripOnEdge, TiltsAtPrandtlsLoad) {
  EXPECT_NEAR(lateral_buckling_gamma(0.5), 12.8538, 5e-5);
  EXPECT_NEAR(lateral_buckling_gamma(1), 18.178, 5e-4);
  const double gamma = lateral_buckling_gamma(0.5);
  EXPECT_NEAR(end_of_linear_mode([](double z) { return z * z * z * z; }, gamma * gamma / 4), 0, 1e-7);
}

TEST(BesselZeros, AreThoseOfTheTables) {
  EXPECT_NEAR(first_bessel_zero(0), 2.404825557695773, 1e-13);
  EXPECT_NEAR(first_bessel_zero(1), 3.831705970207512, 1e-13);
  EXPECT_NEAR(first_bessel_zero(0.5), pi, 1e-13);
}

}  // namespace
}  // namespace cloth::test::exact_heavy_strip_test
