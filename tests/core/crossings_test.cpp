// The tests' own checker of crossings: known cases, touches, misses by one unit in the last place, far from
// the origin, and signs against whole numbers.
#include "support/crossings.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "support/box_sweep.h"
#include "support/exact_sign.h"
#include "support/random.h"

namespace cloth::test::crossings_test {
namespace {

const Vec3 origin(0, 0, 0), far(1e6, -1e6, 1e6);  // doubles near 1e6 are 2^-33 apart
constexpr double unit = 0x1p-10;                  // exact at both

TEST(ExactSign, IsTheSignOfTheDeterminantInWholeNumbers) {
  Random random;
  int zeros = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const int size = random.coin() ? 3 : 1 << 18;  // no determinant leaves 64 bits
    std::array<std::array<std::int64_t, 3>, 4> whole{};
    std::array<Vec3, 4> point;
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        const int x = random.integer(-size, size);
        whole[k][i] = x, point[k][static_cast<Eigen::Index>(i)] = std::ldexp(x, -30);
      }
    }
    const auto d = [&](std::size_t k, std::size_t i) { return whole[k][i] - whole[0][i]; };
    const auto determinant = d(3, 0) * (d(1, 1) * d(2, 2) - d(1, 2) * d(2, 1)) +
                             d(3, 1) * (d(1, 2) * d(2, 0) - d(1, 0) * d(2, 2)) +
                             d(3, 2) * (d(1, 0) * d(2, 1) - d(1, 1) * d(2, 0));
    const int sign = determinant > 0 ? 1 : determinant < 0 ? -1 : 0;
    const auto& [a, b, c, p] = point;
    ASSERT_EQ(side_of_plane(a, b, c, p), sign);
    ASSERT_EQ(side_of_plane_by_expansions(a, b, c, p), sign);
    zeros += sign == 0 ? 1 : 0;
  }
  EXPECT_GT(zeros, 100);
}

TEST(ExactSign, TellsPointsNextToAPlaneApart) {
  Random random;
  for (int trial = 0; trial < 20000; ++trial) {
    const Vec3 shift = random.coin() ? origin : far;
    const Vec3 a = shift + random.vector(1), b = shift + random.vector(1), c = shift + random.vector(1);
    const double u = random.uniform(-1, 2), v = random.uniform(-1, 2);
    Vec3 p = a + u * (b - a) + v * (c - a);
    ASSERT_EQ(side_of_plane(a, b, c, p), side_of_plane_by_expansions(a, b, c, p));
    ASSERT_EQ(side_of_plane(a, b, c, p), -side_of_plane(b, a, c, p));
    ASSERT_EQ(side_of_plane(a, b, c, p), -side_of_plane(a, b, p, c));
  }
  const Vec3 a(0, 0, 1), b(1, 0, 0), c(0, 1, 0), on(0.25, 0.25, 0.5);
  EXPECT_EQ(side_of_plane(a, b, c, on), 0);
  EXPECT_EQ(side_of_plane(a, b, c, {0.25, std::nextafter(0.25, 1), 0.5}), side_of_plane(a, b, c, {1, 1, 1}));
  EXPECT_EQ(side_of_plane(a, b, c, {0.25, std::nextafter(0.25, 0), 0.5}), side_of_plane(a, b, c, origin));
}

TEST(ExactSign, OfTurnsAndHalfSpacesSeesOneUlp) {
  EXPECT_EQ(turn({0, 0, 7}, {3, 3, 8}, {0.1, 0.1, 9}, 2), 0);
  EXPECT_EQ(turn({0, 0, 7}, {3, 3, 8}, {0.1, std::nextafter(0.1, 1), 9}, 2), 1);
  EXPECT_EQ(turn({7, 0, 0}, {8, 3, 3}, {9, std::nextafter(0.1, 1), 0.1}, 0), -1);
  EXPECT_EQ(side_of_half_space({1, 1, 0}, far, far + Vec3(unit, -unit, 5)), 0);
  EXPECT_EQ(side_of_half_space({1, 1, 0}, far, far + Vec3(unit + 0x1p-33, -unit, 5)), 1);
  EXPECT_EQ(side_of_half_space({1, 1e-9, 0}, {0, 1, 0}, {0, 0, 0}), -1);
}

/// A segment and the triangle (0,0,0), (4,0,0), (0,4,0), in units.
bool pierces(const Vec3& shift, const Vec3& p, const Vec3& q) {
  const Vec3 a = shift, b = shift + unit * Vec3(4, 0, 0), c = shift + unit * Vec3(0, 4, 0);
  const Vec3 from = shift + unit * p, to = shift + unit * q;
  const bool meets = segment_meets_triangle(from, to, a, b, c);
  EXPECT_EQ(segment_meets_triangle(to, from, a, b, c), meets);
  EXPECT_EQ(segment_meets_triangle(from, to, c, a, b), meets);
  EXPECT_EQ(segment_meets_triangle(from, to, b, a, c), meets);
  return meets;
}

TEST(SegmentAndTriangle, CrossWhereTheyHaveAPointInCommon) {
  for (const Vec3& shift : {origin, far}) {
    const double ulp = 0x1p-33 / unit;  // at the far place
    EXPECT_TRUE(pierces(shift, {1, 1, -1}, {1, 1, 1}));
    EXPECT_TRUE(pierces(shift, {-3, -3, -4}, {5, 5, 4}));
    EXPECT_FALSE(pierces(shift, {3, 3, -1}, {3, 3, 1}));
    EXPECT_FALSE(pierces(shift, {1, 1, 1}, {1, 1, 3}));
    // Touching: an end on the face, a border, a corner.
    EXPECT_TRUE(pierces(shift, {1, 1, 0}, {1, 1, 1}));
    EXPECT_FALSE(pierces(shift, {1, 1, ulp}, {1, 1, 1}));
    EXPECT_TRUE(pierces(shift, {2, 2, -1}, {2, 2, 1}));
    EXPECT_FALSE(pierces(shift, {2 + ulp, 2, -1}, {2 + ulp, 2, 1}));
    EXPECT_TRUE(pierces(shift, {4, 0, -1}, {4, 0, 1}));
    EXPECT_FALSE(pierces(shift, {4 + ulp, 0, -1}, {4 + ulp, 0, 1}));
    EXPECT_TRUE(pierces(shift, {0, 0, 0}, {-1, -1, -1}));
    EXPECT_FALSE(pierces(shift, {-ulp, 0, 0}, {-1, -1, -1}));
  }
}

TEST(SegmentAndTriangle, CrossInTheirCommonPlane) {
  for (const Vec3& shift : {origin, far}) {
    const double ulp = 0x1p-33 / unit;
    EXPECT_TRUE(pierces(shift, {1, 1, 0}, {2, 1, 0}));    // inside
    EXPECT_TRUE(pierces(shift, {-1, 1, 0}, {5, 1, 0}));   // across
    EXPECT_TRUE(pierces(shift, {-1, 0, 0}, {9, 0, 0}));   // along a border
    EXPECT_TRUE(pierces(shift, {4, 0, 0}, {9, 0, 0}));    // from a corner on
    EXPECT_TRUE(pierces(shift, {-1, 1, 0}, {1, -1, 0}));  // over a corner
    EXPECT_FALSE(pierces(shift, {4 + ulp, 0, 0}, {9, 0, 0}));
    EXPECT_FALSE(pierces(shift, {3, 3, 0}, {5, 1, 0}));
    EXPECT_FALSE(pierces(shift, {1, 1, ulp}, {2, 1, ulp}));
    EXPECT_TRUE(pierces(shift, {1, 1, 0}, {1, 1, 0}));  // a point
    EXPECT_FALSE(pierces(shift, {3, 3, 0}, {3, 3, 0}));
  }
}

TEST(SegmentAndTriangle, WithoutAreaIsWhatItsEdgesAre) {
  const Vec3 a(0, 0, 0), b(1, 1, 1), c(3, 3, 3);
  EXPECT_TRUE(segment_meets_triangle({2, 2, 1}, {2, 2, 3}, a, b, c));
  EXPECT_FALSE(segment_meets_triangle({2, 1, 1}, {2, 1, 3}, a, b, c));
  EXPECT_TRUE(segment_meets_triangle({2, 2, 2}, {9, 9, 9}, a, b, c));
  EXPECT_FALSE(segment_meets_triangle({4, 4, 4}, {9, 9, 9}, a, b, c));
  EXPECT_TRUE(segments_meet(b, b, a, c));
  EXPECT_FALSE(segments_meet({1, 1, 2}, {1, 1, 2}, a, c));
}

/// rows x columns particles one apart in the plane z = 0, then placed.
template <class Place>
TriangleMesh sheet(int rows, int columns, Place place) {
  Vec3Field position(static_cast<std::size_t>(rows * columns));
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      position.set(static_cast<std::size_t>(row * columns + column), place(row, column));
  return grid_triangles(rows, columns, position);
}

TEST(Crossings, CountsEveryPairOnce) {
  const TriangleMesh cloth{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};
  const TriangleMesh needle{{{1, 1, -1}, {1, 1, 1}, {1.5, 1, 1}}, {{0, 1, 2}}};
  const Count count = crossings(cloth, needle);
  EXPECT_EQ(count.number, 2);  // two of its edges
  EXPECT_EQ(count.first, "edge 0-1 of the obstacle and triangle 0 of the cloth");
  EXPECT_EQ(crossings(needle, cloth).number, 2);
  EXPECT_EQ(crossings(needle, cloth).first, "edge 0-1 of the cloth and triangle 0 of the obstacle");
}

TEST(Crossings, LoseNoneFarFromTheOrigin) {
  for (const Vec3& shift : {origin, far}) {
    const auto flat = [&](double height) {
      return sheet(5, 5, [&](int i, int j) { return Vec3(shift + unit * Vec3(i, j, height)); });
    };
    const auto upright =
        sheet(3, 3, [&](int i, int j) { return Vec3(shift + unit * Vec3(i + 0.5, 1.5, j)); });
    const double ulp = 0x1p-33 / unit;
    EXPECT_GT(crossings(flat(1), upright).number, 0);
    EXPECT_GT(crossings(flat(2), upright).number, 0);  // touches its upper border
    EXPECT_EQ(crossings(flat(2 + ulp), upright).number, 0);
    EXPECT_GT(crossings(flat(0), upright).number, 0);
    EXPECT_EQ(crossings(flat(-ulp), upright).number, 0);
  }
}

/// Triangles of all sizes, some of them flat along an axis, on a coarse raster so that many touch.
TriangleMesh random_soup(Random& random, int triangles) {
  TriangleMesh mesh;
  const Vec3 middle = random.vector(1);
  for (int t = 0; t < triangles; ++t) {
    const Vec3 place = middle + random.vector(2);
    const double size = std::pow(2.0, random.integer(-4, 1));
    for (int k = 0; k < 3; ++k) {
      Vec3 vertex = place + random.vector(size);
      if (random.coin()) vertex = (8 * vertex).array().round() / 8;
      mesh.vertices.push_back(vertex);
    }
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    if (t > 0 && random.coin()) mesh.triangles.back()[0] = 3 * random.integer(0, t - 1);
  }
  return mesh;
}

TEST(Crossings, AreTheSameBySweepAsOfAllPairs) {
  Random random;
  int found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const TriangleMesh a = random_soup(random, random.integer(1, 60)),
                       b = random_soup(random, random.integer(1, 60));
    const Count swept = crossings(a, b, Search::sweep), all = crossings(a, b, Search::all_pairs);
    ASSERT_EQ(swept.number, all.number);
    ASSERT_EQ(swept.first, all.first);
    const Count own = self_crossings(a, Search::sweep), own_all = self_crossings(a, Search::all_pairs);
    ASSERT_EQ(own.number, own_all.number);
    ASSERT_EQ(own.first, own_all.first);
    found += all.number + own_all.number;
  }
  EXPECT_GT(found, 1000);
}

TEST(BoxSweep, FindsEveryPairOnceTouchesAndTiesIncluded) {
  Random random;
  std::size_t found = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const auto boxes = [&](int count) {  // whole numbers: many begin, end or touch at the same
      std::vector<Extent> list;
      for (int n = 0; n < count; ++n) {
        Extent box;
        for (std::size_t k = 0; k < 3; ++k) {
          box.least[k] = random.integer(-5, 5);
          box.most[k] = box.least[k] + random.integer(0, 3);
        }
        list.push_back(box);
      }
      return list;
    };
    const std::vector<Extent> a = boxes(random.integer(0, 40)), b = boxes(random.integer(0, 40));
    const std::vector<IndexPair> all = overlaps_of_all_pairs(a, b);
    ASSERT_EQ(overlaps_by_sweep(a, b), all);
    ASSERT_EQ(overlaps_by_sweep(a, a), overlaps_of_all_pairs(a, a));
    found += all.size();
  }
  EXPECT_GT(found, 1000u);
}

TEST(SelfCrossings, AreNoneInAFlatSheetOrABentOne) {
  Random random;
  EXPECT_EQ(self_crossings(sheet(8, 9, [](int i, int j) { return Vec3(i, j, 0); })).number, 0);
  EXPECT_EQ(
      self_crossings(sheet(8, 9, [](int i, int j) { return Vec3(0.1 * i, 0.1 * j, 0.3 * i - 0.7 * j); }))
          .number,
      0);
  EXPECT_EQ(
      self_crossings(sheet(9, 9, [&](int i, int j) { return Vec3(i, j, random.uniform(-1, 1)); })).number, 0);
}

TEST(SelfCrossings, OfAFoldedSheetBeginWhereItsPartsTouch) {
  const auto folded = [](double gap) {  // the second half lies over the first
    return sheet(9, 5, [&](int i, int j) {
      return i < 4 ? Vec3(i, j, 0) : i == 4 ? Vec3(4, j, 0.5 * gap) : Vec3(7.75 - i, j, gap);
    });
  };
  EXPECT_EQ(self_crossings(folded(0.125)).number, 0);
  EXPECT_EQ(self_crossings(folded(5e-324)).number, 0);
  EXPECT_GT(self_crossings(folded(0)).number, 0);
}

TEST(SelfCrossings, AreFoundAtASharedVertex) {
  TriangleMesh mesh{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {2, 2, 1}, {2, 2, -1}}, {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_EQ(self_crossings(mesh).number, 1);
  EXPECT_EQ(self_crossings(mesh).first, "triangles 0 and 1");
  mesh.vertices[3] = {-2, -2, 1}, mesh.vertices[4] = {-2, -2, -1};  // touches in the shared vertex alone
  EXPECT_EQ(self_crossings(mesh).number, 0);
}

TEST(SelfCrossings, OfAStripThroughItselfAreCounted) {
  // Upright through the middle of a flat cell: each of the strip's two vertical edges and its diagonal
  // passes.
  TriangleMesh mesh = sheet(2, 2, [](int i, int j) { return Vec3(4 * i, 4 * j, 0); });
  for (const Vec3& p : {Vec3(3, 1, -1), Vec3(3, 1, 1), Vec3(3.5, 1, -1)}) mesh.vertices.push_back(p);
  mesh.triangles.push_back({4, 5, 6});
  EXPECT_EQ(self_crossings(mesh).number, 1);
}

TEST(TrianglesInSolid, HoldsWhatIsInsideOnItsSurfaceOrThroughIt) {
  const TriangleMesh box = box_triangles({1, 2, 3}, Eigen::Matrix3d::Identity(), {1, 1, 1});
  const auto triangle = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return triangles_in_solid({{a, b, c}, {{0, 1, 2}}}, box).number;
  };
  EXPECT_EQ(triangle({1, 2, 3}, {1.1, 2, 3}, {1, 2.1, 3}), 1);   // inside
  EXPECT_EQ(triangle({-9, -9, 3}, {20, 2, 3}, {-9, 20, 3}), 1);  // all around it
  EXPECT_EQ(triangle({2, 3, 4}, {5, 5, 5}, {5, 4, 5}), 1);       // at a corner
  EXPECT_EQ(triangle({std::nextafter(2, 3), 3, 4}, {5, 5, 5}, {5, 4, 5}), 0);
  EXPECT_EQ(triangle({1, 2, 4}, {1.5, 2, 4}, {1, 2.5, 4}), 1);  // on a face
  const double above = std::nextafter(4, 5);
  EXPECT_EQ(triangle({1, 2, above}, {1.5, 2, above}, {1, 2.5, above}), 0);
  EXPECT_EQ(triangle({1.5, 3.5, 3}, {2.5, 2.5, 3}, {3, 3, 3}), 1);  // an edge of the box through it
  EXPECT_EQ(triangle({1.5, 3.75, 3}, {2.75, 2.5, 3}, {3, 3, 3}), 0);
}

TEST(TrianglesInSolid, TurnedIsMetAlongItsOwnAxes) {
  const Eigen::Matrix3d axes = Eigen::AngleAxisd(0.25 * M_PI, Vec3(0, 0, 1)).toRotationMatrix();
  const TriangleMesh box = box_triangles(origin, axes, {1, 1, 1});
  const auto at = [](double x, double y) {
    return TriangleMesh{{{x, y, 0}, {x + 1, y, 0.5}, {x + 1, y, -0.5}}, {{0, 1, 2}}};
  };
  EXPECT_EQ(triangles_in_solid(at(1.414, 0), box).number, 1);
  EXPECT_EQ(triangles_in_solid(at(1.415, 0), box).number, 0);
  EXPECT_EQ(triangles_in_solid(at(0.9, 0.9), box).number, 0);
}

TEST(WindingNumber, IsExactOnEveryRasterPointOfABox) {
  // Rays meet edges, diagonals and corners of the surface in nearly all of these.
  const TriangleMesh box = box_triangles(origin, Eigen::Matrix3d::Identity(), {4, 4, 4});
  for (int i = -5; i <= 5; ++i)
    for (int j = -5; j <= 5; ++j)
      for (int k = -5; k <= 5; ++k) {
        const Vec3 point(i, j, k);
        if (point.cwiseAbs().maxCoeff() == 4) continue;  // the surface
        const int inside = point.cwiseAbs().maxCoeff() < 4 ? 1 : 0;
        for (int axis = 0; axis < 3; ++axis)
          ASSERT_EQ(winding_number(box, point, axis), inside) << point.transpose();
      }
}

TEST(WindingNumber, SeesOneUlp) {
  for (const Vec3& shift : {origin, far}) {
    const TriangleMesh box = box_triangles(shift, Eigen::Matrix3d::Identity(), Vec3::Constant(4 * unit));
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1, 1}) {
        Vec3 inside = shift, outside = shift;
        inside[axis] += side * (4 * unit - 0x1p-33), outside[axis] += side * (4 * unit + 0x1p-33);
        for (int ray = 0; ray < 3; ++ray) {
          EXPECT_EQ(winding_number(box, inside, ray), 1);
          EXPECT_EQ(winding_number(box, outside, ray), 0);
        }
      }
    }
  }
}

TEST(WindingNumber, ChangesItsSignWithTheFacesAndTellsTheSidesOfASheet) {
  TriangleMesh box = box_triangles(origin, Eigen::Matrix3d::Identity(), {1, 1, 1});
  for (Triangle& t : box.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(winding_number(box, {0.1, 0.2, 0.3}), -1);
  const TriangleMesh floor{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};
  EXPECT_EQ(winding_number(floor, {1, 1, -0.1}), 1);
  EXPECT_EQ(winding_number(floor, {1, 1, 0.1}), 0);
}

TEST(VerticesInside, AndWaysThroughFindWhatHasTunnelled) {
  const TriangleMesh box = box_triangles(origin, Eigen::Matrix3d::Identity(), {1, 1, 1});
  const auto cloth = [](double height) {
    return sheet(5, 5, [&](int i, int j) { return Vec3(i - 2.5, height, j - 2.5); });
  };
  EXPECT_EQ(vertices_inside(cloth(2), box).number, 0);
  EXPECT_EQ(vertices_inside(cloth(0.5), box).number, 4);
  EXPECT_EQ(vertices_inside(cloth(0.5), box).first, "vertex 12");
  EXPECT_EQ(ways_through(cloth(2), cloth(1.5), box).number, 0);
  EXPECT_EQ(ways_through(cloth(2), cloth(-2), box).number, 4);
}

TEST(TrianglesInSphere, HoldsTrianglesByFaceEdgeAndVertex) {
  const auto distance_is = [](double distance, const Vec3& a, const Vec3& b, const Vec3& c) {
    for (const Vec3& shift : {origin, far}) {
      const TriangleMesh triangle{{shift + a, shift + b, shift + c}, {{0, 1, 2}}};
      EXPECT_EQ(triangles_in_sphere(triangle, shift, distance).number, 1) << distance;
      EXPECT_EQ(triangles_in_sphere(triangle, shift, distance * (1 - 1e-15)).number, 0) << distance;
    }
  };
  distance_is(0.5, {-4, -4, 0.5}, {4, -4, 0.5}, {0, 8, 0.5});
  distance_is(5, {3, 4, -1}, {3, 4, 1}, {6, 8, 0});
  distance_is(3, {1, 2, 2}, {4, 4, 4}, {4, 4, 5});
  distance_is(5, {3, 4, -1}, {3, 4, 1}, {3, 4, 0});  // without area
}

TEST(TrianglesInSphere, AgreesWithSampling) {
  Random random;
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 a = random.vector(1), b = random.vector(1), c = random.vector(1);
    double sampled = HUGE_VAL;
    constexpr int n = 60;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        sampled = std::min(sampled, (a + (b - a) * i / n + (c - a) * j / n).norm());
    const TriangleMesh triangle{{a, b, c}, {{0, 1, 2}}};
    EXPECT_EQ(triangles_in_sphere(triangle, origin, sampled + 1e-12).number, 1);
    const double coarse = ((b - a).norm() + (c - a).norm()) / n;
    EXPECT_EQ(triangles_in_sphere(triangle, origin, sampled - coarse).number, 0);
  }
}

TEST(VerticesBelowPlane, HoldsVerticesOnItAndBelow) {
  const TriangleMesh cloth{{far + Vec3(0, 0x1p-33, 0), far, far + Vec3(0, -0x1p-33, 0)}, {}};
  EXPECT_EQ(vertices_below_plane(cloth, far, {0, 3, 0}).number, 2);
  EXPECT_EQ(vertices_below_plane(cloth, far, {0, 3, 0}).first, "vertex 1");
}

}  // namespace
}  // namespace cloth::test::crossings_test
