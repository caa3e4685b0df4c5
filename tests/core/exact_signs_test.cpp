// Signs of orientation against rational arithmetic, and how triangles meet against the checker of crossings,
// most of all where points lie in one plane or nearly so.
#include "geometry/exact_signs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/triangle_intersection.h"
#include "support/crossings.h"
#include "support/exact_sign.h"
#include "support/random.h"

namespace cloth::test::exact_signs_test {
namespace {

/// A rational coordinate is a whole number over a power of two that all have in common: no product of three
/// differences of less than 2^41 leaves 128 bits.
__extension__ using Whole = __int128;
using Whole3 = std::array<std::int64_t, 3>;

Vec3 in_doubles(const Whole3& point, double unit) {
  return {static_cast<double>(point[0]) * unit, static_cast<double>(point[1]) * unit,
          static_cast<double>(point[2]) * unit};
}

int rational_side(const Whole3& a, const Whole3& b, const Whole3& c, const Whole3& p) {
  std::array<Whole, 3> u, v, w;
  for (std::size_t k = 0; k < 3; ++k) u[k] = b[k] - a[k], v[k] = c[k] - a[k], w[k] = p[k] - a[k];
  const Whole volume = w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2]) +
                       w[2] * (u[0] * v[1] - u[1] * v[0]);
  return (volume > 0) - (volume < 0);
}

int rational_turn(std::size_t axis, const Whole3& a, const Whole3& b, const Whole3& c) {
  const std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
  const Whole area = Whole(b[x] - a[x]) * (c[y] - a[y]) - Whole(b[y] - a[y]) * (c[x] - a[x]);
  return (area > 0) - (area < 0);
}

Whole3 random_whole(Random& random, double most) {
  const auto one = [&] { return static_cast<std::int64_t>(random.uniform(-most, most)); };
  return {one(), one(), one()};
}

TEST(SideOfPlane, IsThatOfRationalArithmeticInAndBesideThePlane) {
  Random random;
  int in_plane = 0;
  for (int round = 0; round < 20000; ++round) {
    const double most = std::exp2(random.integer(2, 34));
    const Whole3 a = random_whole(random, most), b = random_whole(random, most),
                 c = random_whole(random, most);
    Whole3 p = a;
    const std::int64_t i = random.integer(-9, 9), j = random.integer(-9, 9);
    for (std::size_t k = 0; k < 3; ++k) p[k] += i * (b[k] - a[k]) + j * (c[k] - a[k]);
    if (random.coin()) p[static_cast<std::size_t>(random.integer(0, 2))] += random.integer(-1, 1);
    const double unit = std::exp2(-random.integer(0, 60));
    const int side = rational_side(a, b, c, p);
    in_plane += side == 0;
    ASSERT_EQ(cloth::side_of_plane(in_doubles(a, unit), in_doubles(b, unit), in_doubles(c, unit),
                                   in_doubles(p, unit)),
              side)
        << "round " << round;
  }
  EXPECT_GT(in_plane, 8000);
}

TEST(SideOfPlane, IsThatOfExpansionsForNumbersOfAnySize) {
  Random random;
  for (int round = 0; round < 20000; ++round) {
    const auto one = [&] { return random.uniform(-1, 1) * std::exp2(random.integer(-40, 10)); };
    const Vec3 a(one(), one(), one()), b(one(), one(), one()), c(one(), one(), one());
    const Vec3 p = a + random.uniform(-1, 2) * (b - a) + random.uniform(-1, 2) * (c - a);  // nearly there
    const int side = test::side_of_plane_by_expansions(a, b, c, p);
    ASSERT_EQ(cloth::side_of_plane(a, b, c, p), side) << "round " << round;
    ASSERT_EQ(cloth::side_of_plane(b, a, c, p), -side) << "round " << round;
    ASSERT_EQ(cloth::side_of_plane(p, b, c, a), -side) << "round " << round;
  }
}

TEST(TurnAround, IsThatOfRationalArithmeticOnAndBesideTheLine) {
  Random random;
  for (int round = 0; round < 20000; ++round) {
    const double most = std::exp2(random.integer(2, 34));
    const Whole3 a = random_whole(random, most), b = random_whole(random, most);
    Whole3 c = a;
    const std::int64_t i = random.integer(-9, 9);
    for (std::size_t k = 0; k < 3; ++k)
      c[k] += i * (b[k] - a[k]) + (random.coin() ? random.integer(-1, 1) : 0);
    for (const std::size_t axis : {0u, 1u, 2u})
      ASSERT_EQ(
          cloth::turn_around(static_cast<int>(axis), in_doubles(a, 1), in_doubles(b, 1), in_doubles(c, 1)),
          rational_turn(axis, a, b, c))
          << "round " << round;
  }
}

bool crossing_by_checker(const Corners& a, const Corners& b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (segment_meets_triangle(a[k], a[(k + 1) % 3], b[0], b[1], b[2]) ||
        segment_meets_triangle(b[k], b[(k + 1) % 3], a[0], a[1], a[2]))
      return true;
  return false;
}

/// On a lattice of few points most triangles touch in a corner, along an edge, in one plane, or have no area;
/// tilted and shifted to where coordinates are rounded, they nearly do.
TEST(TrianglesMeet, WhereTheCheckerOfCrossingsFindsACommonPoint) {
  Random random;
  int met = 0, passing = 0;
  for (int round = 0; round < 40000; ++round) {
    const auto corner = [&] {
      return Vec3(random.integer(0, 3), random.integer(0, 3), random.integer(0, 2));
    };
    Corners a{corner(), corner(), corner()}, b{corner(), corner(), corner()};
    if (random.coin()) {
      const Eigen::Matrix3d tilt =
          Eigen::AngleAxisd(random.uniform(0, 3), random.vector(1).normalized()).matrix();
      for (std::size_t k = 0; k < 3; ++k) a[k] = tilt * a[k], b[k] = tilt * b[k];
    }
    const Intersection meeting = intersection_of(a, b);
    ASSERT_EQ(meeting != Intersection::apart, crossing_by_checker(a, b)) << "round " << round;
    ASSERT_EQ(meeting, intersection_of(b, a)) << "round " << round;
    met += meeting != Intersection::apart, passing += meeting == Intersection::crossing;
  }
  EXPECT_GT(met, 10000);
  EXPECT_GT(passing, 2000);
  EXPECT_GT(met - passing, 2000);
}

TEST(TrianglesPass, AsSoonAsACornerIsBeyondTheOther) {
  const Corners floor{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)};
  const auto tip_at = [](double height) {
    return Corners{Vec3(0.25, height, 0.25), Vec3(0.2, 1, 0.3), Vec3(0.3, 1, 0.3)};
  };
  EXPECT_EQ(intersection_of(floor, tip_at(1e-300)), Intersection::apart);
  EXPECT_EQ(intersection_of(floor, tip_at(0)), Intersection::touching);
  EXPECT_EQ(intersection_of(floor, tip_at(-1e-17)), Intersection::crossing);
}

TEST(TrianglesThatShare, MeetBeyondWhatTheyShareOnly) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(1, -1, 0), over(0.2, 0.3, 0);
  EXPECT_EQ(intersection_beyond_edge(a, b, c, d), Intersection::apart);
  EXPECT_EQ(intersection_beyond_edge(a, b, c, over), Intersection::touching) << "folded flat";
  EXPECT_EQ(intersection_beyond_edge(a, b, c, over + Vec3(0, 0, 1e-300)), Intersection::apart);
  EXPECT_EQ(intersection_beyond_corner({a, b, c}, {a, d, Vec3(0, -1, 0)}), Intersection::apart);
  EXPECT_EQ(intersection_beyond_corner({a, b, c}, {a, Vec3(0.3, 0.3, 1), Vec3(0.3, 0.3, -1)}),
            Intersection::crossing);
  EXPECT_EQ(intersection_beyond_corner({a, b, c}, {a, Vec3(0.3, 0.3, 1), Vec3(0.3, 0.3, 0)}),
            Intersection::touching);
}

}  // namespace
}  // namespace cloth::test::exact_signs_test
