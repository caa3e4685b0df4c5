// The search for near pairs against a look at all pairs of features: nothing that could meet is missed,
// nothing comes twice, and what hierarchies keep from one search to the next changes no answer.
#include "contact/near_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <vector>

#include "contact/obstacle_body.h"
#include "kernels/worker_team.h"
#include "scene/builtin_scenes.h"
#include "scene/obstacle_shape.h"
#include "support/pair_search.h"

namespace cloth::test::near_pairs_test {
namespace {

TEST(NearPairs, MissNoneOfAllPairsThatComeNear) {
  Random random;
  Looked looked;
  for (int trial = 0; trial < 60; ++trial) {
    SCOPED_TRACE(trial);
    const Intersection meeting = random_meeting(random);
    const Motion motion = random_motion(meeting.sheet.position, random.coin() ? 0.01 : 0.1, random);
    std::vector<FeaturePair> pairs;
    PairSearch(meeting.sheet.surface, meeting.sheet.position, meeting.bodies, true, 0.02)
        .find(motion.swept(), meeting.paths, pairs);
    expect_none_missed(pairs, meeting, motion, looked);
  }
  EXPECT_GT(looked.near, 2000u);
  EXPECT_GT(looked.far, 10 * looked.near) << "hardly anything could have been left out";
}

TEST(NearPairs, MissNoneThatAnObstacleSweepsOverAsItTurnsAndShifts) {
  Random random;
  Looked looked;
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(trial);
    Intersection meeting;
    meeting.bodies = {random_body(random.coin() ? &mesh_shape() : &plane_shape(), random)};
    const ObstacleBody& body = meeting.bodies[0];
    const Pose to = about(body.pivot, rotation_matrix(random.uniform(0.5, 2) * random.vector(1).normalized()),
                          body.pivot + random.vector(0.3));
    meeting.paths = {{body.pivot, Pose{}, to}};
    // a small cloth at rest where something of the obstacle comes by
    const Vec3 part_of_it = body.vertices.empty() ? body.point : body.vertices[0];
    const Vec3 place = meeting.paths[0].at(random.integer(1, 5) / 6.0).at(part_of_it);
    meeting.sheet = random_sheet(3, 3, random);
    for (std::size_t i = 0; i < meeting.sheet.position.size(); ++i)
      meeting.sheet.position.set(i, place + 0.01 * meeting.sheet.position[i]);
    Motion motion{meeting.sheet.position, meeting.sheet.position, 1e-4, 1e-3, 0};
    std::vector<FeaturePair> pairs;
    PairSearch(meeting.sheet.surface, meeting.sheet.position, meeting.bodies, false, 0)
        .find(motion.swept(), meeting.paths, pairs);
    expect_none_missed(pairs, meeting, motion, looked, false);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(looked.near, 1000u);
}

TEST(NearPairs, ComeOnceAndAreOfFeaturesThatExist) {
  Random random;
  for (int trial = 0; trial < 60; ++trial) {
    const Intersection meeting = random_meeting(random);
    const Motion motion = random_motion(meeting.sheet.position, 0.05, random);
    std::vector<FeaturePair> pairs;
    PairSearch(meeting.sheet.surface, meeting.sheet.position, meeting.bodies, true, 0.02)
        .find(motion.swept(), meeting.paths, pairs);
    const std::set<FeaturePair> found = told_apart(pairs);
    EXPECT_EQ(found.size(), pairs.size()) << "some came twice";
    const std::vector<FeaturePair> all = all_pairs(meeting.sheet.surface, meeting.bodies, true);
    const std::set<FeaturePair> known = told_apart(all);
    EXPECT_TRUE(std::includes(known.begin(), known.end(), found.begin(), found.end()));
  }
}

TEST(NearPairs, OfObstaclesFarAwayAreNone) {
  Random random;
  Intersection meeting;
  meeting.sheet = random_sheet(4, 4, random);
  for (const Shape shape : {&sphere_shape(), &box_shape(), &mesh_shape()}) {
    meeting.bodies.push_back(random_body(shape, random));
    meeting.paths.emplace_back(Vec3::Zero(), Pose{}, Pose{});
    meeting.paths.back() =
        PoseInterpolation(meeting.bodies.back().pivot, {Eigen::Matrix3d::Identity(), {0, 9, 0}},
                          {Eigen::Matrix3d::Identity(), {3, 5, 0}});
  }
  std::vector<FeaturePair> pairs{FeaturePair{}};
  PairSearch(meeting.sheet.surface, meeting.sheet.position, meeting.bodies, false, 0)
      .find(random_motion(meeting.sheet.position, 0, random).swept(), meeting.paths, pairs);
  EXPECT_TRUE(pairs.empty());
}

TEST(NearPairs, DoNotDependOnWhatEarlierSearchesKept) {
  Random random;
  std::size_t compared = 0;
  for (int trial = 0; trial < 20; ++trial) {
    constexpr double skin = 0.02;
    std::unique_ptr<PairSearch> keeping;
    walk(random, [&](const Intersection& meeting, const Motion& motion, bool begins) {
      if (begins)
        keeping = std::make_unique<PairSearch>(meeting.sheet.surface, meeting.sheet.position, meeting.bodies,
                                               true, skin);
      std::vector<FeaturePair> pairs, fresh;
      keeping->find(motion.swept(), meeting.paths, pairs);
      PairSearch(meeting.sheet.surface, meeting.sheet.position, meeting.bodies, true, skin)
          .find(motion.swept(), meeting.paths, fresh);
      ASSERT_EQ(pairs, fresh);
      compared += pairs.size();
    });
  }
  EXPECT_GT(compared, 10000u);
}

/// A few particles leave the regions that were kept, on a sheet that drifts and that several threads share;
/// the numbers that stand for the regions change, and a mesh is moved now and then.
TEST(NearPairs, DoNotDependOnWhatEarlierSearchesKeptWhereFewParticlesMove) {
  Random random;
  WorkerTeam team(3);
  std::size_t compared = 0, of_mesh = 0;
  for (int trial = 0; trial < 12; ++trial) {
    SCOPED_TRACE(trial);
    Intersection meeting;
    meeting.sheet = random_sheet(15, 15, random);
    const Sheet& sheet = meeting.sheet;
    meeting.bodies = {random_body(&mesh_shape(), random), random_body(&mesh_shape(), random)};
    for (const ObstacleBody& body : meeting.bodies) meeting.paths.emplace_back(body.pivot, Pose{}, Pose{});
    constexpr double skin = 0.02;
    PairSearch keeping(sheet.surface, sheet.position, meeting.bodies, true, skin), in_shares = keeping;
    in_shares.set_team(&team);
    Motion motion{sheet.position, sheet.position, 0.0005, 0.01, 0.01};
    for (std::size_t i = 0; i < motion.to.size(); ++i) motion.to.add(i, 0.03 * trial * Vec3(-1, 1, -1));
    for (int step = 0; step < 30; ++step) {
      for (std::size_t i = 0; i < motion.to.size(); ++i) {
        motion.to.add(i, {0.001, -0.002, 0.003});
        if (random.integer(0, 9) == 0) motion.to.add(i, random.vector(step % 3 == 0 ? 0.02 : 0.001));
      }
      motion.from = motion.to;
      if (step % 10 == 9) {
        const Pose shifted = about(meeting.bodies[1].pivot, Eigen::Matrix3d::Identity(),
                                   meeting.bodies[1].pivot + random.vector(0.1));
        meeting.paths[1] = {meeting.bodies[1].pivot, shifted, shifted};
      }
      std::vector<FeaturePair> pairs, shared, fresh;
      keeping.find(motion.swept(), meeting.paths, pairs);
      in_shares.find(motion.swept(), meeting.paths, shared);
      PairSearch(sheet.surface, sheet.position, meeting.bodies, true, skin)
          .find(motion.swept(), meeting.paths, fresh);
      ASSERT_EQ(pairs, fresh) << step;
      ASSERT_EQ(shared, fresh) << step;
      compared += pairs.size();
      for (const FeaturePair& pair : pairs) of_mesh += pair.obstacle != FeaturePair::cloth_itself ? 1 : 0;
    }
  }
  EXPECT_GT(compared, 20000u);
  EXPECT_GT(of_mesh, 2000u);
}

/// Every sixth particle, of which the search's numbers are made, moves within its region; the others stay at
/// the borders of theirs.
TEST(NearPairs, DoNotDependOnTheNumbersOfEarlierSearches) {
  Random random;
  const Sheet sheet = random_sheet(14, 14, random);
  const std::vector<ObstacleBody> none;
  std::size_t compared = 0;
  for (int place = 0; place < 100; ++place) {
    SweptBounds swept{.reach = 0.1, .own_reach = 0.1};
    swept.from = sheet.position;
    for (std::size_t i = 0; i < swept.from.size(); ++i) {
      swept.from.add(i, 0.01 * place * Vec3(1, 1, 1));
      swept.radius.push_back(i % 6 == 0 ? 0.03 : 0.001);
    }
    swept.to = swept.from;
    PairSearch keeping(sheet.surface, sheet.position, none, true, 0);
    std::vector<FeaturePair> pairs, fresh;
    keeping.find(swept, {}, pairs);
    for (std::size_t i = 0; i < swept.size(); i += 6) {
      swept.from.add(i, Vec3::Constant(0.015));
      swept.to.set(i, swept.from[i]);
      swept.radius[i] = 0.001;
    }
    keeping.find(swept, {}, pairs);
    PairSearch(sheet.surface, sheet.position, none, true, 0).find(swept, {}, fresh);
    ASSERT_EQ(pairs, fresh) << place;
    compared += pairs.size();
  }
  EXPECT_GT(compared, 10000u);
}

/// There single precision has a millimetre, more than what the search's numbers tell apart.
TEST(NearPairs, WithAMeshFarFromTheOriginDoNotDependOnEarlierSearches) {
  Random random;
  std::size_t compared = 0;
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    const Vec3 far = Vec3::Constant(1e4);
    Sheet sheet = random_sheet(8, 8, random);
    for (std::size_t i = 0; i < sheet.position.size(); ++i) sheet.position.add(i, far);
    std::vector<ObstacleBody> bodies{random_body(&mesh_shape(), random)};
    for (Vec3& vertex : bodies[0].vertices) vertex += far;
    const std::vector<PoseInterpolation> paths{{far, Pose{}, Pose{}}};
    PairSearch keeping(sheet.surface, sheet.position, bodies, true, 0);
    Motion motion{sheet.position, sheet.position, 0.03, 0.01, 0.01};
    std::vector<FeaturePair> pairs, fresh;
    keeping.find(motion.swept(), paths, pairs);
    motion.margin = 0.0005;
    keeping.find(motion.swept(), paths, pairs);
    PairSearch(sheet.surface, sheet.position, bodies, true, 0).find(motion.swept(), paths, fresh);
    ASSERT_EQ(pairs, fresh);
    for (const FeaturePair& pair : pairs) compared += pair.obstacle != FeaturePair::cloth_itself ? 1 : 0;
  }
  EXPECT_GT(compared, 500u);
}

TEST(NearPairs, OfFewParticlesAreFoundByMoreThreadsThanThereAre) {
  Random random;
  const std::vector<ObstacleBody> bodies{body_of(builtin_scene("bunny").obstacles[0])};
  Sheet sheet = random_sheet(3, 3, random);
  for (std::size_t i = 0; i < sheet.position.size(); ++i) sheet.position.add(i, {0, 0.3, 0});
  std::vector<PoseInterpolation> paths;
  for (const ObstacleBody& body : bodies) paths.emplace_back(body.pivot, Pose{}, Pose{});
  const Motion motion{sheet.position, sheet.position, 0.001, 0.2, 0.01};
  WorkerTeam team(12);
  PairSearch alone(sheet.surface, sheet.position, bodies, true, 0.02), shared = alone;
  shared.set_team(&team);
  std::vector<FeaturePair> pairs, of_shares;
  alone.find(motion.swept(), paths, pairs);
  shared.find(motion.swept(), paths, of_shares);
  EXPECT_EQ(pairs, of_shares);
  EXPECT_GT(pairs.size(), 10000u);
}

/// A particle that has flown off widens what the search counts in, but not for the others.
TEST(NearPairs, OfTheOthersStayFewWhereAParticleIsFarAway) {
  Random random;
  const Sheet sheet = random_sheet(12, 12, random);
  const std::vector<ObstacleBody> bodies{random_body(&mesh_shape(), random)};
  const std::vector<PoseInterpolation> paths{{bodies[0].pivot, Pose{}, Pose{}}};
  for (const double far : {1e2, 1e6, 1e12}) {
    const auto of_others = [&](double apart) {
      const std::size_t flown = 77;
      Motion motion{sheet.position, sheet.position, 0.001, 0.002, 0.002};
      motion.from.add(flown, Vec3(apart, -apart, 0));
      motion.to = motion.from;
      std::vector<FeaturePair> pairs;
      PairSearch(sheet.surface, sheet.position, bodies, true, 0.02).find(motion.swept(), paths, pairs);
      const auto has_flown = [&](const std::vector<int>& particles) {
        return std::find(particles.begin(), particles.end(), static_cast<int>(flown)) != particles.end();
      };
      return std::count_if(pairs.begin(), pairs.end(), [&](const FeaturePair& pair) {
        return !has_flown(near_particles(pair, sheet.surface)) &&
               (pair.obstacle != FeaturePair::cloth_itself || !has_flown(far_particles(pair, sheet.surface)));
      });
    };
    const auto together = of_others(0), apart = of_others(far);
    EXPECT_GT(together, 100);
    EXPECT_LE(apart, together + together / 10) << far;
    EXPECT_GE(apart, together / 2) << far;
  }
}

}  // namespace
}  // namespace cloth::test::near_pairs_test
