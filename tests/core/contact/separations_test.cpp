// Many pairs at once against the functions for one pair.
#include "contact/separations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "contact/distance_bounds.h"
#include "geometry/at.h"
#include "geometry/bounds.h"
#include "kernels/instruction_set.h"
#include "scene/obstacle_shape.h"
#include "support/contact_bodies.h"

namespace cloth::test::separations_test {
namespace {

struct EveryInstructionSet : ::testing::Test {
  ~EveryInstructionSet() override { set_instruction_set(std::nullopt); }
};

/// Calls `look` for a crumpled or flat sheet among obstacles at random, with all pairs that there are, in
/// every instruction set. Edges of a flat sheet are parallel to many others.
template <class Look>
void for_random_settings(const Look& look) {
  Random random;
  for (int trial = 0; trial < 12; ++trial) {
    Sheet sheet = random_sheet(5, 4, random);
    if (trial % 3 == 0)
      for (std::size_t i = 0; i < sheet.position.size(); ++i)
        sheet.position.set(i, {0.1 * static_cast<double>(i % 4), 0, 0.1 * static_cast<double>(i / 4)});
    if (trial % 4 == 1) sheet.position.set(3, sheet.position[4]);  // an edge without length
    std::vector<ObstacleBody> bodies;
    std::vector<Pose> poses;
    for (const ObstacleShape* one : obstacle_shapes()) {
      bodies.push_back(random_body(one, random));
      poses.push_back(random_interpolation(bodies.back(), random).at(random.uniform(0, 1)));
    }
    std::vector<FeaturePair> pairs = all_pairs(sheet.surface, bodies, true);
    pairs.resize(pairs.size() - static_cast<std::size_t>(random.integer(0, ClosestBlock::size - 1)));
    for (const InstructionSet set : supported_instruction_sets()) {
      set_instruction_set(set);
      SCOPED_TRACE(name_of(set));
      look(PairSetting{sheet.surface, sheet.position, bodies, poses}, pairs);
    }
  }
}

void expect_same(const Separation& s, const Separation& alone) {
  EXPECT_EQ(s.count, alone.count);
  EXPECT_EQ(s.near_count, alone.near_count);
  EXPECT_EQ(s.particle, alone.particle);
  EXPECT_EQ(s.weight, alone.weight);
  EXPECT_EQ(s.normal, alone.normal);
  EXPECT_EQ(s.far_point, alone.far_point);
  EXPECT_EQ(s.distance, alone.distance);
  EXPECT_EQ(s.near_level, alone.near_level);
  EXPECT_EQ(s.far_level, alone.far_level);
  EXPECT_EQ(s.nearest, alone.nearest);
}

TEST_F(EveryInstructionSet, SeparatesManyPairsToTheBitAsEachAlone) {
  constexpr NearDistances within{0.2, 0.1};
  int nearest = 0;
  for_random_settings([&](const PairSetting& setting, const std::vector<FeaturePair>& pairs) {
    std::vector<Separation> all(pairs.size());
    PairBatch(setting).separate(pairs, within, all.data());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      SCOPED_TRACE(testing::Message() << "pair " << k << " of kind " << static_cast<int>(pairs[k].kind));
      expect_same(all[k], separate(pairs[k], setting, within(pairs[k])));
      if (::testing::Test::HasFailure()) return;
      nearest += all[k].nearest;
    }
  });
  EXPECT_GT(nearest, 1000);
}

TEST_F(EveryInstructionSet, LeavesOutOnlyPairsThatCannotComeNearOrAreNotNearest) {
  constexpr NearDistances within{10, 10}, reach{0.5, 0.4};
  int apart = 0, waiting = 0, beyond = 0, nearest = 0;
  for_random_settings([&](const PairSetting& setting, const std::vector<FeaturePair>& pairs) {
    Random random;
    std::vector<double> motion;
    for (std::size_t k = 0; k < pairs.size(); ++k) motion.push_back(random.uniform(0, 0.25));
    std::vector<Separation> all(pairs.size());
    std::vector<PairNeed> needs(pairs.size());
    std::size_t next = 0;
    PairBatch(setting).separate(pairs, within, {motion, reach},
                                [&](std::size_t k, PairNeed need, const Separation& separation) {
                                  EXPECT_EQ(k, next++);
                                  needs[k] = need, all[k] = separation;
                                });
    EXPECT_EQ(next, pairs.size());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      SCOPED_TRACE(testing::Message() << "pair " << k << " of kind " << static_cast<int>(pairs[k].kind));
      const Separation alone = separate(pairs[k], setting, within(pairs[k]));
      if (needs[k] == PairNeed::separation) expect_same(all[k], alone);
      if (needs[k] == PairNeed::apart) {
        EXPECT_GT(alone.distance, reach(pairs[k]) + motion[k]);
      }
      if (needs[k] == PairNeed::waits) {
        EXPECT_GT(alone.distance, 2 * motion[k]);
        EXPECT_LE(alone.distance, reach(pairs[k]) + motion[k]);
        EXPECT_FALSE(alone.nearest);
        beyond += alone.distance > reach(pairs[k]) ? 1 : 0;
      }
      if (::testing::Test::HasFailure()) return;
      apart += needs[k] == PairNeed::apart, waiting += needs[k] == PairNeed::waits, nearest += alone.nearest;
    }
  });
  EXPECT_GT(apart, 1000);
  EXPECT_GT(waiting, 10000);
  EXPECT_GT(beyond, 1000);
  EXPECT_GT(nearest, 1000);
}

TEST_F(EveryInstructionSet, FindsTheDistancesOfTheSeparations) {
  for_random_settings([&](const PairSetting& setting, const std::vector<FeaturePair>& pairs) {
    std::vector<double> all(pairs.size());
    PairBatch(setting).find_distances(pairs, all.data());
    for (std::size_t k = 0; k < pairs.size(); ++k)
      ASSERT_EQ(all[k], separate(pairs[k], setting, 0).distance) << static_cast<int>(pairs[k].kind);
  });
}

/// Also far from the origin, where only differences of coordinates are small.
TEST_F(EveryInstructionSet, BoundsDistancesFromBelow) {
  constexpr double of_rounding = 1e-9, close = 2e-5;  // m
  int with_vertices = 0, weak = 0;
  for_random_settings([&](const PairSetting& near, const std::vector<FeaturePair>& unsorted) {
    std::vector<FeaturePair> pairs = unsorted;
    std::sort(pairs.begin(), pairs.end());
    for (const double away : {0.0, 1e6}) {
      const Vec3 shift(away, -away, 0.5 * away);
      Vec3Field position = near.position;
      for (std::size_t i = 0; i < position.size(); ++i) position.add(i, shift);
      std::vector<Pose> poses = near.poses;
      for (Pose& pose : poses) pose.translation += shift;
      const PairSetting setting{near.cloth, position, near.bodies, poses};
      std::vector<double> distances(pairs.size()), bounds(pairs.size());
      PairBatch(setting).find_distances(pairs, distances.data());
      DistanceBounds of_pairs;
      of_pairs.begin(setting, pairs);
      const std::size_t part = pairs.size() / 3;  // the calls of two threads
      of_pairs.find(setting, std::span(pairs).first(part), bounds.data());
      of_pairs.find(setting, std::span(pairs).subspan(part), bounds.data() + part);
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        ASSERT_LE(bounds[k], distances[k] + of_rounding) << static_cast<int>(pairs[k].kind) << " at " << away;
        if (shape_of(pairs[k].kind) == PairShape::point_and_solid || pairs[k].kind == PairKind::face_sphere)
          continue;
        ++with_vertices, weak += bounds[k] < distances[k] - close ? 1 : 0;
      }
    }
  });
  EXPECT_GT(with_vertices, 100000);
  EXPECT_LT(weak, with_vertices / 1000);
}

/// m, of the points as they are when rounded.
double distance_in(const std::array<RoundedPoint, 4>& points, bool of_segments) {
  std::array<Vec3, 4> p;
  for (std::size_t k = 0; k < 4; ++k) p[k] = Vec3(points[k].of[0], points[k].of[1], points[k].of[2]);
  const Vec3 apart = of_segments ? closest_of_segments(p[0], p[1], p[2], p[3]).separation
                                 : closest_on_triangle(p[0], p[1], p[2], p[3]).separation;
  return apart.norm();
}

/// Slivers whose normal is shorter than single precision has squares of; sizes from there to beyond it.
TEST_F(EveryInstructionSet, BoundsDistancesOfEverySizeFromBelow) {
  Random random;
  std::vector<std::array<RoundedPoint, 4>> all{
      {{{{.01F, 0, .5F, 0}}, {{0, 0, 0, 0}}, {{.01F, 0, 0, 0}}, {{.02F, 1e-20F, 0, 0}}}},
      {{{{0, .1F, 0, 0}}, {{0, 0, 0, 0}}, {{1e-17F, 0, 0, 0}}, {{0, 0, 1e-3F, 0}}}}};
  const auto rounded = [](const Vec3& p) {
    return RoundedPoint{{static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()), 0}};
  };
  for (int power = -30; power <= 30; ++power)
    for (int trial = 0; trial < 200; ++trial) {
      const double size = std::pow(10.0, power) * random.uniform(1, 10);
      std::array<Vec3, 4> p;
      for (Vec3& point : p) point = random.vector(size);
      if (trial % 3 == 0) p[0] = 0.2 * p[1] + 0.5 * p[2] + 0.3 * p[3];  // in the triangle
      if (trial % 3 == 1) p[3] = p[2] + 1e-6 * (p[3] - p[2]);           // a sliver, a short segment
      all.push_back({rounded(p[0]), rounded(p[1]), rounded(p[2]), rounded(p[3])});
    }
  constexpr PairVertices pair{{0, 1, 2, 3}};
  for (const InstructionSet set : supported_instruction_sets()) {
    set_instruction_set(set);
    const BoundKernels& kernels = active_kernels<BoundKernels>();
    for (const auto& points : all)
      for (const bool of_segments : {false, true}) {
        float bound = 0;
        (of_segments ? kernels.of_segments : kernels.of_triangles)(points.data(), points.data(), &pair, 1,
                                                                   &bound);
        ASSERT_LE(static_cast<double>(bound), (1 + 1e-12) * distance_in(points, of_segments))
            << name_of(set) << ", " << points[1].of[0] << ", segments " << of_segments;
      }
  }
}

TEST_F(EveryInstructionSet, BoundsNothingTooFarAway) {
  constexpr float huge = 1e30F, infinity = std::numeric_limits<float>::infinity();
  for (const InstructionSet set : supported_instruction_sets()) {
    set_instruction_set(set);
    const BoundKernels& kernels = active_kernels<BoundKernels>();
    for (const float number : {2e5F, 1e10F, huge, -huge, infinity, -infinity}) {
      const std::array<RoundedPoint, 4> points{
          RoundedPoint{{0, 0, 0, 0}}, {{1, 0, 0, 0}}, {{0, 1, 0, 0}}, {{0, number, 1, 0}}};
      constexpr PairVertices pair{{0, 1, 2, 3}};
      float bound = 0;
      kernels.of_segments(points.data(), points.data(), &pair, 1, &bound);
      EXPECT_EQ(bound, -infinity) << name_of(set) << number;
      kernels.of_triangles(points.data(), points.data(), &pair, 1, &bound);
      EXPECT_EQ(bound, -infinity) << name_of(set) << number;
    }
  }
}

TEST_F(EveryInstructionSet, SeparatesFromObstaclesAtRestToTheBitAsFromMovingOnes) {
  for_random_settings([&](const PairSetting& setting, const std::vector<FeaturePair>& pairs) {
    PlacedBodies placed;
    placed.update(setting.bodies, setting.poses);
    placed.update(setting.bodies, setting.poses);
    for (std::size_t k = 0; k < setting.bodies.size(); ++k)
      ASSERT_NE(placed.plane(static_cast<int>(k)), nullptr);
    PairSetting at_rest = setting;
    at_rest.placed = &placed;
    for (const FeaturePair& pair : pairs) {
      expect_same(separate(pair, at_rest, 0.2), separate(pair, setting, 0.2));
      if (::testing::Test::HasFailure()) return;
    }
  });
}

TEST(PlacedBodies, AreThoseOfThePresentPoseOrNone) {
  ObstacleBody plane;
  plane.kind = BodyKind::half_space;
  ObstacleBody mesh;
  mesh.kind = BodyKind::surface, mesh.vertices = {{1, 2, 3}};
  const std::vector<ObstacleBody> bodies{plane, mesh};
  std::vector<Pose> poses(2);
  PlacedBodies placed;
  placed.update(bodies, poses);
  EXPECT_EQ(placed.vertices(1), nullptr);
  placed.update(bodies, poses);
  ASSERT_NE(placed.vertices(1), nullptr);
  EXPECT_EQ(*placed.vertices(1), Vec3(1, 2, 3));
  poses[1].translation = {1, 0, 0};
  placed.update(bodies, poses);
  EXPECT_EQ(placed.vertices(1), nullptr);
  ASSERT_NE(placed.plane(0), nullptr);
  placed.update(bodies, poses);
  ASSERT_NE(placed.vertices(1), nullptr);
  EXPECT_EQ(*placed.vertices(1), Vec3(2, 2, 3));
}

}  // namespace
}  // namespace cloth::test::separations_test
