// Polygons of many corners cut into triangles.
#include "geometry/polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "support/random.h"

namespace cloth::test::polygon_test {
namespace {

using Outline = std::vector<Vec3>;

std::vector<int> all_corners(const Outline& outline) {
  std::vector<int> corners(outline.size());
  std::iota(corners.begin(), corners.end(), 0);
  return corners;
}

Vec3 area_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * (b - a).cross(c - a);
}

/// As many triangles as corners less two; their areas point one way and add up to the polygon's, so that they
/// cover it once.
void expect_covered(const Outline& outline, const std::string& what) {
  const std::vector<Triangle> triangles = cut_polygon(outline, all_corners(outline));
  ASSERT_EQ(triangles.size() + 2, outline.size()) << what;
  Vec3 whole = Vec3::Zero();
  for (std::size_t k = 1; k + 1 < outline.size(); ++k)
    whole += area_of(outline[0], outline[k], outline[k + 1]);
  double sum = 0;
  for (const Triangle& t : triangles) {
    const auto at = [&](std::size_t k) { return outline[static_cast<std::size_t>(t[k])]; };
    const Vec3 area = area_of(at(0), at(1), at(2));
    ASSERT_GE(area.dot(whole), -1e-12 * whole.squaredNorm()) << what;
    sum += area.norm();
  }
  EXPECT_NEAR(sum, whole.norm(), 1e-9 * whole.norm()) << what;
}

Outline star(int corners, double inner, double spread, Random& random) {
  Outline outline;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    const double radius = (k % 2 == 0 ? 1 : inner) * (1 - spread * random.uniform(0, 1));
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return outline;
}

/// Teeth along a straight back, all valleys on a line.
Outline comb(int teeth) {
  Outline outline{{0, -5, 0}, {2.0 * teeth, -5, 0}};
  for (int k = teeth; k > 0; --k) {
    outline.emplace_back(2 * k, 100, 0);
    outline.emplace_back(2 * k - 1, 1, 0);
  }
  outline.emplace_back(0, 100, 0);
  return outline;
}

Outline spiral(int corners) {
  Outline outline;
  for (int k = 0; k < corners; ++k) {
    const bool out = k < corners / 2;
    const double angle = 60.0 * (out ? k : corners - 1 - k) / corners;
    const double radius = 1 + angle + (out ? 0 : 0.5);
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return outline;
}

/// A square around square holes, each reached and left by the same seam.
Outline with_holes(int holes) {
  Outline outline{{0, 0, 0}};
  for (int k = 0; k < holes; ++k) {
    const double x = k + 0.25;
    const Vec3 on_edge(x, 0, 0);
    outline.push_back(on_edge);
    for (const auto& [u, v] : {std::pair{0.0, 0.25}, {0.0, 0.75}, {0.5, 0.75}, {0.5, 0.25}, {0.0, 0.25}})
      outline.emplace_back(x + u, v, 0);
    outline.push_back(on_edge);
  }
  outline.insert(outline.end(), {{double(holes), 0, 0}, {double(holes), 1, 0}, {0, 1, 0}});
  return outline;
}

TEST(CutPolygon, CoversEverySimplePolygonOnceHoweverItLies) {
  Random random;
  for (const int n : {3, 4, 5, 7, 30, 101, 1000})
    for (int way = 0; way < 8; ++way) {
      const Eigen::Quaterniond turn(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
                                    random.uniform(-1, 1));
      std::vector<std::pair<Outline, std::string>> outlines{{star(n, 1, 0, random), "circle"},
                                                            {star(2 * n, 0.4, 0, random), "star"},
                                                            {star(n, 1, 0.7, random), "ragged"},
                                                            {comb(n), "comb"},
                                                            {spiral(2 * n + 20), "spiral"}};
      for (auto& [outline, what] : outlines) {
        if (way % 2 == 1) std::reverse(outline.begin(), outline.end());
        std::rotate(outline.begin(), outline.begin() + random.integer(0, 2), outline.end());
        if (way > 1)
          for (Vec3& point : outline) point = turn.normalized() * point;
        expect_covered(outline, what + " of " + std::to_string(n) + ", way " + std::to_string(way));
      }
    }
}

TEST(CutPolygon, CoversAnOutlineThatTouchesItselfAlongSeams) {
  for (const int holes : {1, 2, 10}) expect_covered(with_holes(holes), std::to_string(holes) + " holes");
}

TEST(CutPolygon, OfManyPointsOnALineOrAtOnePlaceEnds) {
  const Outline line(100, Vec3(1, 2, 3));
  EXPECT_EQ(cut_polygon(line, all_corners(line)).size(), 98U);
  Outline straight;
  for (int k = 0; k < 100; ++k) straight.emplace_back(k, 2 * k, 0);
  EXPECT_EQ(cut_polygon(straight, all_corners(straight)).size(), 98U);
}

/// Twenty times the corners take some twenty times as long; the square of that would be minutes.
TEST(CutPolygon, CutsHundredsOfThousandsOfCorners) {
  Random random;
  for (const Outline& outline : {star(200'000, 0.5, 0.3, random), comb(100'000), spiral(200'000)})
    expect_covered(outline, "large");
}

TEST(CutPolygon, GivesUpOnAPolygonThatCrossesItselfEverywhereInBoundedTime) {
  Random random;
  Outline outline;
  for (int k = 0; k < 50'000; ++k) outline.emplace_back(random.uniform(0, 1), random.uniform(0, 1), 0);
  const auto triangles = cut_polygon(outline, all_corners(outline));
  EXPECT_TRUE(triangles.empty() || triangles.size() == outline.size() - 2);
}

}  // namespace
}  // namespace cloth::test::polygon_test
