// What separate() says of two features, for random pairs of every kind: a plane that really parts them, and
// which of the pairs around a point is the nearest.
#include "contact/feature_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/at.h"
#include "geometry/bounds.h"
#include "scene/obstacle_shape.h"
#include "support/contact_bodies.h"
#include "support/crossings.h"

namespace cloth::test::feature_pairs_test {
namespace {

constexpr double rounding = 1e-12;

/// Points of the far feature, among them all its corners; of a ball, a solid box and a half-space some of
/// each.
std::vector<Vec3> sampled_far_points(const FeaturePair& pair, const Sheet& sheet,
                                     const std::vector<ObstacleBody>& bodies, const std::vector<Pose>& poses,
                                     Random& random) {
  std::vector<Vec3> points;
  if (pair.obstacle == FeaturePair::cloth_itself) {
    const auto& face = sheet.surface.triangles[pair.kind == PairKind::vertex_face ? at(pair.far_feature) : 0];
    const auto& edge = sheet.surface.edges[pair.kind == PairKind::edge_edge ? at(pair.far_feature) : 0];
    if (pair.kind == PairKind::vertex_face)
      for (const int i : face) points.push_back(sheet.position[at(i)]);
    else
      for (const int i : edge) points.push_back(sheet.position[at(i)]);
    return points;
  }
  const ObstacleBody& body = bodies[at(pair.obstacle)];
  constexpr int samples = 50;
  if (pair.kind == PairKind::face_sphere)
    for (int n = 0; n < samples; ++n)
      points.push_back(body.center + body.radius * random.vector(1).normalized());
  else if (pair.kind == PairKind::vertex_box)
    points = body.vertices;
  else if (pair.kind == PairKind::vertex_plane)
    for (int n = 0; n < samples; ++n) {
      const Vec3 any = random.vector(1), along = any - body.normal.dot(any) * body.normal;
      points.push_back(body.point + along - random.uniform(0, 1) * body.normal);
    }
  else
    points = far_points(pair, body);
  for (Vec3& point : points) point = poses[at(pair.obstacle)].at(point);
  return points;
}

struct Setting {
  Sheet sheet;
  std::vector<ObstacleBody> bodies;
  std::vector<Pose> poses;
};

Setting random_setting(Random& random) {
  Setting setting;
  setting.sheet = random_sheet(4, 4, random);
  for (const ObstacleShape* one : obstacle_shapes()) {
    setting.bodies.push_back(random_body(one, random));
    setting.poses.push_back(random_interpolation(setting.bodies.back(), random).at(random.uniform(0, 1)));
  }
  return setting;
}

/// Calls `look` for many random pairs of all kinds that do not meet.
template <class Look>
void for_random_pairs(const Look& look) {
  Random random;
  int looked = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Setting setting = random_setting(random);
    const Surface& surface = setting.sheet.surface;
    for (const FeaturePair& pair : all_pairs(surface, setting.bodies, true)) {
      if (random.integer(0, 3) > 0 && pair.far_feature > 0) continue;
      const Separation s =
          separate(pair, {surface, setting.sheet.position, setting.bodies, setting.poses}, Bounds::infinity);
      if (!(s.distance > 1e-6)) continue;
      ++looked;
      look(setting, pair, s, random);
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
  EXPECT_GT(looked, 10000);
}

TEST(ASeparation, PartsTheFeaturesByItsLevels) {
  for_random_pairs([](const Setting& setting, const FeaturePair& pair, const Separation& s, Random& random) {
    ASSERT_NEAR(s.normal.norm(), 1, rounding);
    for (int k = 0; k < s.near_count; ++k)
      ASSERT_GE(s.normal.dot(setting.sheet.position[at(s.particle[at(k)])]), s.near_level - rounding);
    for (const Vec3& point : sampled_far_points(pair, setting.sheet, setting.bodies, setting.poses, random))
      ASSERT_LE(s.normal.dot(point), s.far_level + rounding) << static_cast<int>(pair.kind);
    ASSERT_LE(s.gap(), s.distance + rounding);
    ASSERT_GE(s.gap(), s.distance - 1e-7) << static_cast<int>(pair.kind) << ": a plane as good as none";
  });
}

TEST(ASeparation, NamesThePointsOfItsDistance) {
  for_random_pairs([](const Setting& setting, const FeaturePair& pair, const Separation& s, Random&) {
    Vec3 near = Vec3::Zero(), far = Vec3::Zero();
    double near_sum = 0, far_sum = 0;
    for (int k = 0; k < s.count; ++k) {
      const Vec3 part = s.weight[at(k)] * setting.sheet.position[at(s.particle[at(k)])];
      if (k < s.near_count) {
        ASSERT_GE(s.weight[at(k)], 0);
        near += part, near_sum += s.weight[at(k)];
      } else {
        ASSERT_LE(s.weight[at(k)], 0);
        far -= part, far_sum -= s.weight[at(k)];
      }
    }
    ASSERT_NEAR(near_sum, 1, rounding);
    const bool itself = pair.obstacle == FeaturePair::cloth_itself;
    ASSERT_NEAR(far_sum, itself ? 1 : 0, rounding);
    ASSERT_LE((near - (itself ? far : s.far_point) - s.distance * s.normal).norm(), 1e-9)
        << static_cast<int>(pair.kind);
    std::vector<int> particles(s.particle.begin(), s.particle.begin() + s.near_count);
    ASSERT_EQ(particles, near_particles(pair, setting.sheet.surface));
  });
}

/// Of all pairs of an obstacle with some of the cloth's features, those that are nearest.
std::vector<Separation> nearest_of(const std::vector<FeaturePair>& pairs, const Setting& setting) {
  std::vector<Separation> nearest;
  for (const FeaturePair& pair : pairs) {
    const Separation s =
        separate(pair, {setting.sheet.surface, setting.sheet.position, setting.bodies, setting.poses},
                 Bounds::infinity);
    if (s.nearest) nearest.push_back(s);
  }
  return nearest;
}

/// From behind, the inside of a face is nearest too: nothing next to it is closer.
TEST(TheNearestPair, AmongTheFacesThatAParticleSeesOfAConvexMeshIsOne) {
  Random random;
  int several = 0;
  constexpr int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    Setting setting;
    setting.sheet = random_sheet(3, 3, random);
    ObstacleBody body = random_body(&mesh_shape(), random);
    TriangleMesh box = box_triangles(Vec3::Zero(), Eigen::Matrix3d::Identity(), {0.1, 0.2, 0.15});
    body.vertices = box.vertices;
    body.surface = make_surface(8, box.triangles);
    setting.bodies = {body};
    setting.poses = {random_interpolation(body, random).from()};
    const Vec3 out = 0.3 * random.vector(1).normalized() + Vec3(0, random.uniform(-0.2, 0.2), 0);
    if (out.cwiseAbs().cwiseQuotient(Vec3(0.1, 0.2, 0.15)).maxCoeff() < 1.01) continue;
    setting.sheet.position.set(0, setting.poses[0].at(out));
    std::vector<FeaturePair> pairs;
    for (int t = 0; t < static_cast<int>(box.triangles.size()); ++t) {
      const auto& [a, b, c] = box.triangles[at(t)];
      const Vec3 &pa = box.vertices[at(a)], &pb = box.vertices[at(b)], &pc = box.vertices[at(c)];
      if ((pb - pa).cross(pc - pa).dot(out - pa) > 0) pairs.push_back({0, PairKind::vertex_face, 0, t});
    }
    double least = HUGE_VAL;
    for (const FeaturePair& pair : pairs)
      least = std::min(
          least,
          separate(pair, {setting.sheet.surface, setting.sheet.position, setting.bodies, setting.poses},
                   Bounds::infinity)
              .distance);
    const std::vector<Separation> nearest = nearest_of(pairs, setting);
    ASSERT_GE(nearest.size(), 1u);
    for (const Separation& s : nearest) ASSERT_NEAR(s.distance, least, 1e-3 * least);
    several += nearest.size() > 1 ? 1 : 0;
  }
  EXPECT_LT(several, trials / 50) << "more than the slack of nearly flat edges explains";
}

TEST(TheNearestPair, OfASphereIsTheFaceWithTheClosestPoint) {
  Random random;
  for (int trial = 0; trial < 500; ++trial) {
    Setting setting;
    setting.sheet = random_sheet(4, 4, random);
    setting.bodies = {random_body(&sphere_shape(), random)};
    setting.poses = {Pose{Eigen::Matrix3d::Identity(), random.vector(0.2)}};
    std::vector<FeaturePair> pairs = all_pairs(setting.sheet.surface, setting.bodies, false);
    double least = HUGE_VAL;
    for (const FeaturePair& pair : pairs)
      least = std::min(
          least,
          separate(pair, {setting.sheet.surface, setting.sheet.position, setting.bodies, setting.poses},
                   Bounds::infinity)
              .distance);
    int closest = 0;
    for (const Separation& s : nearest_of(pairs, setting)) closest += s.distance <= least + rounding ? 1 : 0;
    ASSERT_EQ(closest, 1) << "of the faces around the closest point one answers for it";
  }
}

TEST(APairThatMeets, HasNoNormalAndIsNoPush) {
  Setting setting;
  Random random;
  setting.sheet = random_sheet(3, 3, random);
  setting.bodies = {random_body(&mesh_shape(), random)};
  setting.poses = {Pose{}};
  const auto& [a, b, c] = setting.bodies[0].surface.triangles[0];
  const auto& vertices = setting.bodies[0].vertices;
  setting.sheet.position.set(0, vertices[at(a)]);
  const Separation s = separate(
      {0, PairKind::vertex_face, 0, 0},
      {setting.sheet.surface, setting.sheet.position, setting.bodies, setting.poses}, Bounds::infinity);
  EXPECT_EQ(s.distance, 0);
  EXPECT_EQ(s.normal, Vec3(0, 0, 0));
  EXPECT_FALSE(s.gap() > 0);
}

TEST(AParticleInABox, IsToldTheNearestWayOut) {
  Setting setting;
  Random random;
  setting.sheet = random_sheet(3, 3, random);
  Obstacle box;
  box.shape = &box_shape();
  box.size = {1, 1, 1};
  setting.bodies = {body_of(box)};
  setting.poses = {Pose{}};
  setting.sheet.position.set(0, {0.1, 0.45, -0.2});
  const Separation s = separate(
      {0, PairKind::vertex_box, 0, 0},
      {setting.sheet.surface, setting.sheet.position, setting.bodies, setting.poses}, Bounds::infinity);
  EXPECT_EQ(s.normal, Vec3(0, 1, 0));
  EXPECT_NEAR(s.distance, -0.05, rounding);
  EXPECT_NEAR(s.gap(), -0.05, rounding);
  EXPECT_TRUE(s.nearest);
}

}  // namespace
}  // namespace cloth::test::feature_pairs_test
