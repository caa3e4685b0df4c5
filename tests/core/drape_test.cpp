// The shadow of a draped cloth, its coefficient and folds, on shapes known by hand.
#include "measure/drape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace cloth::test::drape_test {
namespace {

constexpr double pi = std::numbers::pi;

/// A disc in rings and sectors, each point (radius, angle) put where `to` says.
struct Specimen {
  std::vector<Triangle> triangles;
  Vec3Field flat, position;
};
Specimen round_specimen(double radius, const std::function<Vec3(double, double)>& to, int rings = 20,
                        int sectors = 360) {
  Specimen s;
  const auto particles = static_cast<std::size_t>(1 + rings * sectors);
  s.flat = Vec3Field(particles), s.position = Vec3Field(particles);
  const auto at = [&](int ring, int sector) {
    return ring == 0 ? 0 : 1 + (ring - 1) * sectors + sector % sectors;
  };
  for (int ring = 0; ring <= rings; ++ring)
    for (int sector = 0; sector < (ring == 0 ? 1 : sectors); ++sector) {
      const double r = radius * ring / rings, angle = 2 * pi * sector / sectors;
      s.flat.set(static_cast<std::size_t>(at(ring, sector)), {r * std::cos(angle), 0, r * std::sin(angle)});
      s.position.set(static_cast<std::size_t>(at(ring, sector)), to(r, angle));
    }
  for (int ring = 0; ring < rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      if (ring > 0) s.triangles.push_back({at(ring, sector), at(ring + 1, sector), at(ring, sector + 1)});
      s.triangles.push_back({at(ring, sector + 1), at(ring + 1, sector), at(ring + 1, sector + 1)});
    }
  return s;
}

Vec3 in_plane(double radius, double angle, double height = 0) {
  return {radius * std::cos(angle), height, radius * std::sin(angle)};
}

Drape drape_of(const Specimen& s) {
  return measure_drape(s.triangles, s.flat, s.position, {.radius = 0.09});
}

TEST(Drape, OfAFlatClothIsOne) {
  const Drape drape = drape_of(round_specimen(0.15, [](double r, double a) { return in_plane(r, a); }));
  EXPECT_NEAR(drape.specimen, pi * 0.0225, 1e-4 * drape.specimen);  // a polygon of 360 sides
  EXPECT_NEAR(drape.coefficient, 1, 1e-4);
  EXPECT_EQ(drape.folds, 0);
  EXPECT_EQ(drape.amplitude, 0);
}

TEST(Drape, OfAClothThatHangsStraightDownIsZero) {
  const Drape drape = drape_of(round_specimen(
      0.15, [](double r, double a) { return in_plane(std::min(r, 0.09), a, -std::max(0.0, r - 0.09)); }));
  EXPECT_NEAR(drape.coefficient, 0, 1e-4);
  EXPECT_EQ(drape.folds, 0);
}

/// r = mean + amplitude cos(n angle) beyond the disc has the area pi (mean^2 + amplitude^2/2).
TEST(Drape, OfACosineHasItsAreaItsFoldsAndItsAmplitude) {
  for (const int folds : {3, 5, 8, 12}) {
    const double mean = 0.12, amplitude = 0.012;
    const Drape drape = drape_of(round_specimen(0.15, [&](double r, double a) {
      const double part = std::max(0.0, r - 0.09) / 0.06;
      return in_plane(std::min(r, 0.09) + part * (mean - 0.09 + amplitude * std::cos(folds * a)), a,
                      -0.05 * part);
    }));
    const double area = pi * (mean * mean + 0.5 * amplitude * amplitude);
    EXPECT_NEAR(drape.shadow, area, 3e-4 * area);
    EXPECT_NEAR(drape.coefficient, (area - pi * 0.0081) / (pi * (0.0225 - 0.0081)), 1e-3);
    EXPECT_EQ(drape.folds, folds);
    EXPECT_NEAR(drape.amplitude, amplitude, 0.02 * amplitude);
  }
}

TEST(Drape, DoesNotCountRipplesLowerThanTwoHundredthsOfTheRadius) {
  const auto with = [](double amplitude) {
    return drape_of(round_specimen(0.15,
                                   [&](double r, double a) {
                                     return in_plane(r * (0.8 + amplitude * std::cos(7 * a)), a);
                                   }))
        .folds;
  };
  EXPECT_EQ(with(0.009), 0);
  EXPECT_EQ(with(0.011), 7);
}

TEST(Drape, CastsOneShadowWhereClothLiesOverCloth) {
  // Two squares of 0.2 m, one over the other and shifted by 0.05 m along x: 0.25 m by 0.2 m together.
  Vec3Field position(8);
  std::size_t i = 0;
  for (const double shift : {0.0, 0.05})
    for (const auto& [x, z] : {std::pair{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}})
      position.set(i++, {x + shift, -shift, z});
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
  EXPECT_NEAR(shadow_area(triangles, position, {.radius = 0.05}), 0.05, 1e-3 * 0.05);
}

TEST(Drape, IsTheSameWhereverUpIs) {
  const auto shape = [](double r, double a) { return in_plane(r * (0.8 + 0.1 * std::cos(4 * a)), a, -r); };
  Specimen s = round_specimen(0.15, shape);
  const Drape expected = drape_of(s);
  const Eigen::AngleAxisd turn(1.1, Vec3(1, -2, 0.5).normalized());
  for (Vec3Field* field : {&s.position, &s.flat})
    for (std::size_t i = 0; i < field->size(); ++i) field->set(i, turn * (*field)[i] + Vec3(1, 2, 3));
  const Drape turned = measure_drape(s.triangles, s.flat, s.position,
                                     {.middle = {1, 2, 3}, .radius = 0.09, .up = turn * Vec3(0, 1, 0)});
  EXPECT_NEAR(turned.coefficient, expected.coefficient, 1e-4);
  EXPECT_EQ(turned.folds, 4);
}

/// A square is no fold of a cloth: what was cut so looks so.
TEST(Drape, DoesNotCountTheCornersOfAFlatCloth) {
  const auto square = [](double r, double a) -> Vec3 {
    return in_plane(r / std::max(std::abs(std::cos(a)), std::abs(std::sin(a))), a);
  };
  Specimen s = round_specimen(0.15, square);
  s.flat = s.position;
  EXPECT_EQ(drape_of(s).folds, 0);
  EXPECT_NEAR(drape_of(s).coefficient, 1, 1e-3);
}

/// Between exact lines a disc's width changes by 4 R in all, and the promised bound is far away.
TEST(Drape, HasAnErrorWithinTheStatedBoundOnEveryNumberOfLines) {
  const Specimen s = round_specimen(
      0.15, [](double r, double a) { return in_plane(r, a); }, 20, 1440);
  double sum = 0;
  for (int k = 0; k < 1440; ++k) sum += 0.5 * 0.0225 * std::sin(2 * pi / 1440);
  for (const int lines : {20, 100, 500, 2000}) {
    const double spacing = 0.3 / lines,
                 error = shadow_area(s.triangles, s.position, {.radius = 0.09}, lines) - sum;
    EXPECT_LT(std::abs(error), 0.5 * spacing * 0.6) << lines;
    EXPECT_LT(std::abs(error), 0.5 * std::pow(spacing, 1.5) * std::sqrt(0.15)) << lines;
  }
}

TEST(Shadow, OfASheetSeenEdgeOnIsNothingAndOfNoPlaceNoNumber) {
  const std::vector<Triangle> triangle{{0, 1, 2}};
  Vec3Field position(3);
  for (const double angle : {0.0, std::numbers::pi / 4, std::numbers::pi / 2}) {
    position.set(0, {0, 0, 0}), position.set(1, {std::cos(angle), 0, std::sin(angle)});
    position.set(2, {0, 1, 0});
    EXPECT_NEAR(shadow_area(triangle, position, {.radius = 0}), 0, 1e-15);
  }
  position.set(1, {std::numeric_limits<double>::quiet_NaN(), 0, 0});
  EXPECT_TRUE(std::isnan(shadow_area(triangle, position, {.radius = 0.1})));
  EXPECT_TRUE(std::isnan(shadow_outline(triangle, position, {.radius = 0.1}).front()));
  EXPECT_TRUE(std::isnan(measure_drape(triangle, position, position, {.radius = 0.1}).shadow));
}

}  // namespace
}  // namespace cloth::test::drape_test
