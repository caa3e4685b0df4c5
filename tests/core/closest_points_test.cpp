// Closest points: what is nearest is proved by the condition for the least of a convex function, and compared
// with sampling.
#include "geometry/closest_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/random.h"

namespace cloth::test::closest_points_test {
namespace {

/// Features of every kind of bad shape, about 1 m large.
struct Shapes {
  Random random;

  Vec3 point() { return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); }
  /// Another point: anywhere, near, the same, or along a line with the first two.
  Vec3 another(const Vec3& a, const Vec3& b) {
    switch (random.integer(0, 7)) {
      case 0:
        return a;
      case 1:
        return b + std::pow(10, random.uniform(-18, -2)) * point();
      case 2:
        return a + random.uniform(-1, 2) * (b - a);
      case 3:
        return a + random.uniform(-1, 2) * (b - a) + std::pow(10, random.uniform(-18, -2)) * point();
      case 4:  // on a raster: ties and right angles
        return Vec3(random.integer(-1, 1), random.integer(-1, 1), random.integer(-1, 1));
      default:
        return point();
    }
  }
};

void expect_weights(const std::vector<double>& weights) {
  double sum = 0;
  for (const double w : weights) {
    EXPECT_GE(w, 0);
    EXPECT_LE(w, 1);
    sum += w;
  }
  EXPECT_NEAR(sum, 1, 4e-16);
}

/// No point of a convex hull is nearer to `point` than |separation| - excess, if no vertex lies further than
/// `excess` from the foot towards the point. Rounding blurs this certificate at distances like the unit's
/// own.
void expect_least(const Vec3& point, const Vec3& separation, const std::vector<Vec3>& hull, double excess) {
  constexpr double rounding = 1e-11;
  const double distance = separation.norm();
  if (distance <= excess) return;
  for (const Vec3& vertex : hull)
    EXPECT_LE((vertex - (point - separation)).dot(separation), excess * distance + rounding)
        << "at a distance of " << distance;
}

constexpr double exact = 1e-14, sound = 1e-12, slender = 2e-8;  // m: for features of some 1 m

bool well_shaped(const Vec3& u, const Vec3& v) {
  return u.cross(v).norm() > 1e-3 * u.norm() * v.norm();
}

TEST(PointSegment, FindsKnownFeet) {
  const Vec3 a(0, 0, 0), b(2, 0, 0);
  const PointSegment middle = closest_on_segment({0.5, 3, 4}, a, b);
  EXPECT_EQ(middle.weight, 0.25);
  EXPECT_EQ(middle.separation, Vec3(0, 3, 4));
  EXPECT_EQ(middle.squared_distance, 25);
  EXPECT_EQ(closest_on_segment({-1, 1, 0}, a, b).weight, 0);
  EXPECT_EQ(closest_on_segment({3, 1, 0}, a, b).weight, 1);
  EXPECT_EQ(closest_on_segment({3, 1, 0}, a, b).separation, Vec3(1, 1, 0));
}

TEST(PointSegment, IsLeastForEveryShape) {
  Shapes shapes;
  for (int trial = 0; trial < 100000 && !HasFailure(); ++trial) {
    const Vec3 a = shapes.point(), b = shapes.another(a, a), p = shapes.another(a, b);
    const PointSegment result = closest_on_segment(p, a, b);
    expect_weights({result.weight, 1 - result.weight});
    expect_least(p, result.separation, {a, b}, exact);
    EXPECT_LE((p - (1 - result.weight) * a - result.weight * b - result.separation).norm(), exact);
    EXPECT_EQ(result.squared_distance, result.separation.squaredNorm());
  }
}

TEST(PointTriangle, FindsKnownFeetInAllSevenRegions) {
  const Vec3 a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  const auto weights = [&](const Vec3& p) { return closest_on_triangle(p, a, b, c).weights; };
  using Weights = std::array<double, 3>;
  EXPECT_EQ(weights({1, 1, 7}), (Weights{0.5, 0.25, 0.25}));
  EXPECT_EQ(weights({-1, -1, 7}), (Weights{1, 0, 0}));
  EXPECT_EQ(weights({6, -1, 7}), (Weights{0, 1, 0}));
  EXPECT_EQ(weights({-1, 6, 7}), (Weights{0, 0, 1}));
  EXPECT_EQ(weights({1, -1, 7}), (Weights{0.75, 0.25, 0}));
  EXPECT_EQ(weights({-1, 1, 7}), (Weights{0.75, 0, 0.25}));
  EXPECT_EQ(weights({3, 3, 7}), (Weights{0, 0.5, 0.5}));
  EXPECT_EQ(closest_on_triangle({1, 1, 7}, a, b, c).squared_distance, 49);
  EXPECT_EQ(closest_on_triangle({1, 1, -7}, a, b, c).separation, Vec3(0, 0, -7));
}

TEST(PointTriangle, IsLeastForEveryShape) {
  Shapes shapes;
  for (int trial = 0; trial < 200000 && !HasFailure(); ++trial) {
    const Vec3 a = shapes.point(), b = shapes.another(a, a), c = shapes.another(a, b),
               p = shapes.another(b, c);
    const PointTriangle result = closest_on_triangle(p, a, b, c);
    const auto [wa, wb, wc] = result.weights;
    expect_weights({wa, wb, wc});
    expect_least(p, result.separation, {a, b, c}, well_shaped(b - a, c - a) ? sound : slender);
    EXPECT_LE((p - wa * a - wb * b - wc * c - result.separation).norm(), exact);
    EXPECT_EQ(result.squared_distance, result.separation.squaredNorm());
  }
}

TEST(PointTriangle, TellsTheSmallestDistances) {
  Random random;
  for (int trial = 0; trial < 20000 && !HasFailure(); ++trial) {
    const auto lattice = [&] { return Vec3(random.integer(-9, 9), random.integer(-9, 9), 0); };
    const Vec3 a = lattice(), b = lattice(), c = lattice();
    const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u),
                 height = std::pow(10, random.uniform(-16, 0));
    Vec3 p = a + u * (b - a) + v * (c - a);
    p.z() = height;
    const double distance = std::sqrt(closest_on_triangle(p, a, b, c).squared_distance);
    EXPECT_NEAR(distance, height, 5e-13) << a.transpose() << "; " << b.transpose() << "; " << c.transpose();
  }
}

TEST(PointTriangle, IsNoFurtherThanAnySample) {
  Shapes shapes;
  for (int trial = 0; trial < 500 && !HasFailure(); ++trial) {
    const Vec3 a = shapes.point(), b = shapes.another(a, a), c = shapes.another(a, b),
               p = shapes.another(b, c);
    double sampled = HUGE_VAL;
    constexpr int n = 40;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        sampled = std::min(sampled, (p - a - (b - a) * i / n - (c - a) * j / n).norm());
    const double distance = std::sqrt(closest_on_triangle(p, a, b, c).squared_distance);
    EXPECT_LE(distance, sampled + slender);
    EXPECT_GE(distance, sampled - ((b - a).norm() + (c - a).norm()) / n - exact);
  }
}

TEST(SegmentSegment, FindsKnownPairs) {
  const SegmentSegment cross = closest_of_segments({-1, 0, 3}, {1, 0, 3}, {0, -1, 0}, {0, 3, 0});
  EXPECT_EQ(cross.first, 0.5);
  EXPECT_EQ(cross.second, 0.25);
  EXPECT_EQ(cross.separation, Vec3(0, 0, 3));
  EXPECT_EQ(cross.squared_distance, 9);
  const SegmentSegment ends = closest_of_segments({0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {3, 5, 0});
  EXPECT_EQ(ends.first, 1);
  EXPECT_EQ(ends.second, 0);
  EXPECT_EQ(ends.separation, Vec3(-1, -1, 0));
  const SegmentSegment parallel = closest_of_segments({0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {5, 1, 0});
  EXPECT_EQ(parallel.separation, Vec3(0, -1, 0));
  const SegmentSegment points = closest_of_segments({1, 2, 3}, {1, 2, 3}, {1, 2, 5}, {1, 2, 5});
  EXPECT_EQ(points.separation, Vec3(0, 0, -2));
}

TEST(SegmentSegment, IsLeastForEveryShape) {
  Shapes shapes;
  for (int trial = 0; trial < 200000 && !HasFailure(); ++trial) {
    const Vec3 a = shapes.point(), b = shapes.another(a, a), c = shapes.another(a, b),
               d = shapes.another(b, c);
    const SegmentSegment result = closest_of_segments(a, b, c, d);
    const auto [s, t] = std::pair(result.first, result.second);
    expect_weights({s, 1 - s});
    expect_weights({t, 1 - t});
    // The least of all pairs is the least from the origin to the differences of the ends.
    const double slack = well_shaped(b - a, d - c) ? sound : slender;
    expect_least({0, 0, 0}, -result.separation, {a - c, a - d, b - c, b - d}, slack);
    EXPECT_LE((a + s * (b - a) - c - t * (d - c) - result.separation).norm(), exact);
    EXPECT_EQ(result.squared_distance, result.separation.squaredNorm());
  }
}

TEST(SegmentSegment, TellsTheSmallestDistances) {
  Random random;
  for (int trial = 0; trial < 20000 && !HasFailure(); ++trial) {
    const auto lattice = [&](double z) { return Vec3(random.integer(-9, 9), random.integer(-9, 9), z); };
    const double height = std::pow(10, random.uniform(-16, 0));
    const Vec3 a = lattice(0), b = lattice(0), direction = lattice(0);
    const Vec3 above = a + random.uniform(0, 1) * (b - a) + Vec3(0, 0, height);
    const SegmentSegment result = closest_of_segments(a, b, above - random.uniform(0, 1) * direction,
                                                      above + random.uniform(0, 1) * direction);
    EXPECT_NEAR(result.separation.norm(), height, 5e-13);
  }
}

TEST(SegmentSegment, CrossingAtAVerySmallAngleTouches) {
  for (const double angle : {1e-1, 1e-3, 1e-5, 1e-7, 1e-9, 1e-12, 1e-15}) {
    const SegmentSegment result =
        closest_of_segments({-1, -angle, 0}, {1, angle, 0}, {-1, 0, 0}, {1.5, 0, 0});
    EXPECT_LE(result.separation.norm(), 1e-15) << angle;
  }
}

TEST(ClosestPoints, AreFiniteForTheSmallestAndTheLargest) {
  Shapes shapes;
  for (const double scale : {0.0, 1e-300, 1e-160, 1e-80, 1e-40, 1e40, 1e70}) {
    for (int trial = 0; trial < 1000; ++trial) {
      const Vec3 a = scale * shapes.point(), b = scale * shapes.another(a, a),
                 c = scale * shapes.another(a, b), d = scale * shapes.another(b, c);
      EXPECT_TRUE(closest_on_segment(d, a, b).separation.allFinite()) << scale;
      EXPECT_TRUE(closest_on_triangle(d, a, b, c).separation.allFinite()) << scale;
      EXPECT_TRUE(closest_of_segments(a, b, c, d).separation.allFinite()) << scale;
      const auto [wa, wb, wc] = closest_on_triangle(d, a, b, c).weights;
      expect_weights({wa, wb, wc});
      ASSERT_FALSE(HasFailure()) << scale;
    }
  }
}

TEST(ClosestPoints, LoseNothingFarFromTheOrigin) {
  const Vec3 far(1e6, -1e6, 1e6);  // where numbers are 2^-33 apart
  const double unit = 0x1p-20;
  const Vec3 a = far, b = far + Vec3(8 * unit, 0, 0), c = far + Vec3(0, 8 * unit, 0);
  const PointTriangle above = closest_on_triangle(far + Vec3(unit, 2 * unit, unit), a, b, c);
  EXPECT_EQ(above.weights, (std::array<double, 3>{0.625, 0.125, 0.25}));
  EXPECT_EQ(above.separation, Vec3(0, 0, unit));
  EXPECT_EQ(closest_of_segments(a, b, far + Vec3(unit, -unit, unit), far + Vec3(unit, unit, unit)).separation,
            Vec3(0, 0, -unit));
}

OrientedBox turned_box() {
  OrientedBox box;
  box.center = {1, 2, 3}, box.half = {0.5, 1, 1.5};
  box.axes = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  return box;
}

Vec3 placed(const OrientedBox& box, const Vec3& local) {
  return box.center + box.axes * local;
}

TEST(PointBox, MeetsFacesEdgesAndCornersOfATurnedBox) {
  const OrientedBox box = turned_box();
  const PointBox face = closest_on_box(placed(box, {0.75, 0.5, -1}), box);
  EXPECT_NEAR(face.distance, 0.25, 1e-15);
  EXPECT_LE((face.point - placed(box, {0.5, 0.5, -1})).norm(), 2e-15);
  EXPECT_LE((face.normal - box.axes.col(0)).norm(), 1e-14);
  const PointBox corner = closest_on_box(placed(box, {1.5, 3, -3.5}), box);
  EXPECT_NEAR(corner.distance, 3, 1e-14);
  EXPECT_LE((corner.normal - box.axes * Vec3(1, 2, -2) / 3).norm(), 1e-14);
}

TEST(PointBox, LeavesAlongTheLeastDepth) {
  const OrientedBox box = turned_box();
  const PointBox inside = closest_on_box(placed(box, {0.1, -0.9, 1}), box);
  EXPECT_NEAR(inside.distance, -0.1, 1e-14);
  EXPECT_EQ(inside.normal, Vec3(-box.axes.col(1)));
  EXPECT_LE((inside.point - placed(box, {0.1, -1, 1})).norm(), 2e-15);
  OrientedBox upright;
  upright.half = {1, 1, 1};
  EXPECT_EQ(closest_on_box({0, 0, 0}, upright).normal, Vec3(1, 0, 0));
  EXPECT_EQ(closest_on_box({0, -1, 0}, upright).normal, Vec3(0, -1, 0));
  EXPECT_EQ(closest_on_box({0, -1, 0}, upright).distance, 0);
}

TEST(PointBox, HasAUnitNormalAndASurfacePointEverywhere) {
  Random random;
  const OrientedBox box = turned_box();
  for (int trial = 0; trial < 20000 && !HasFailure(); ++trial) {
    const Vec3 p = box.center + random.vector(1);
    const PointBox result = closest_on_box(p, box);
    EXPECT_NEAR(result.normal.norm(), 1, 1e-14);
    EXPECT_LE((p - result.point - result.distance * result.normal).norm(), 1e-14);
    const Vec3 depth = box.half - (box.axes.transpose() * (result.point - box.center)).cwiseAbs();
    EXPECT_NEAR(depth.minCoeff(), 0, 1e-14);
  }
}

TEST(PointBox, IsNoFurtherThanAnySampleOfTheSurface) {
  Random random;
  const OrientedBox box = turned_box();
  std::vector<Vec3> samples;
  for (int i = 0; i < 20000; ++i) {
    Vec3 local(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    local[i % 3] = random.coin() ? 1 : -1;
    samples.push_back(placed(box, local.cwiseProduct(box.half)));
  }
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 p = box.center + random.vector(1);
    double sampled = HUGE_VAL;
    for (const Vec3& sample : samples) sampled = std::min(sampled, (p - sample).norm());
    const double distance = std::abs(closest_on_box(p, box).distance);
    EXPECT_LE(distance, sampled + 1e-14);
    EXPECT_GE(distance, sampled - 0.2);
  }
}

TEST(OrientedBox, HasTwelveEdgesAlongItsAxes) {
  const OrientedBox box = turned_box();
  const auto corner = corners(box);
  for (std::size_t k = 0; k < box_edges.size(); ++k) {
    const auto [i, j] = box_edges[k];
    const Vec3 edge = corner[static_cast<std::size_t>(j)] - corner[static_cast<std::size_t>(i)];
    const auto axis = static_cast<Eigen::Index>(k / 4);
    EXPECT_LE((edge - 2 * box.half[axis] * box.axes.col(axis)).norm(), 1e-14);
  }
}

}  // namespace
}  // namespace cloth::test::closest_points_test
