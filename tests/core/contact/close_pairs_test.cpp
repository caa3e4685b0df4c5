// Pairs that act and pairs that wait against a look at all pairs of features, and whatever was kept before.
#include "contact/close_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "support/pair_search.h"

namespace cloth::test::close_pairs_test {
namespace {

std::vector<Pose> poses_at_begin(const Intersection& meeting) {
  std::vector<Pose> poses;
  for (const PoseInterpolation& path : meeting.paths) poses.push_back(path.from());
  return poses;
}

/// What ClosePairs finds.
struct Found {
  std::vector<FeaturePair> pairs;
  std::vector<Separation> separations;
  std::vector<WaitingPair> waiting;

  Found(ClosePairs& close, const PairQuery& now) { close.find(now, pairs, separations, waiting); }

  std::vector<FeaturePair> all() const {
    std::vector<FeaturePair> both = pairs;
    for (const WaitingPair& one : waiting) both.push_back(one.pair);
    return both;
  }
};

struct Walks {
  int trials = 12;
  double wide = 1;     ///< factor of the reaches, and divisor of the margins
  double resting = 0;  ///< part of the particles that rest in a round while their neighbours move
};

/// Calls `look` in random walks with what is found by one search after the other, and by a search of its own.
template <class Look>
void find_on_walks(const Walks& walks, const Look& look) {
  Random random;
  for (int trial = 0; trial < walks.trials; ++trial) {
    SCOPED_TRACE(trial);
    std::unique_ptr<ClosePairs> keeping;
    double reach = 0;
    walk(random, [&](const Intersection& meeting, Motion motion, bool begins) {
      motion.reach *= walks.wide, motion.own_reach *= walks.wide, motion.margin /= walks.wide;
      for (std::size_t i = 0; walks.resting > 0 && i < motion.to.size(); ++i)
        if (random.uniform(0, 1) < walks.resting) motion.to.set(i, motion.from[i]);
      const Sheet& sheet = meeting.sheet;
      const auto search = [&] {
        return std::make_unique<ClosePairs>(sheet.surface, sheet.position, meeting.bodies, true, 0.02);
      };
      if (begins) keeping = search();
      if (motion.reach != reach) keeping->forget();
      reach = motion.reach;
      const SweptBounds swept = motion.swept();
      const std::vector<Pose> poses = poses_at_begin(meeting);
      const PairQuery now{motion.from, swept, meeting.paths, poses};
      look(meeting, motion, now, Found(*keeping, now), Found(*search(), now));
    });
  }
}

TEST(ClosePairs, MissNoneAndDoNotDependOnWhatWasKept) {
  Looked looked;
  std::size_t compared = 0, differing = 0;
  find_on_walks({}, [&](const Intersection& meeting, const Motion& motion, const PairQuery& now,
                        const Found& found, const Found& fresh) {
    ASSERT_EQ(found.pairs, fresh.pairs);
    ASSERT_EQ(found.waiting, fresh.waiting);
    ASSERT_EQ(found.separations.size(), found.pairs.size());
    for (std::size_t k = 0; k < found.pairs.size(); ++k) {
      ASSERT_EQ(found.separations[k].distance, fresh.separations[k].distance);
      differing +=
          found.separations[k].distance !=
          separate(found.pairs[k], {meeting.sheet.surface, motion.from, meeting.bodies, now.poses}, 0)
              .distance;
    }
    compared += found.pairs.size();
    expect_none_missed(found.all(), meeting, motion, looked);
  });
  EXPECT_EQ(differing, 0u) << "separations of another situation";
  EXPECT_GT(compared, 3000u);
  EXPECT_GT(looked.near, 2000u);
}

TEST(ClosePairs, DoNotDependOnWhatWasKeptWhereNeighboursMoveUnevenly) {
  std::size_t waiting = 0, acting = 0;
  find_on_walks(
      {.trials = 100, .wide = 10, .resting = 0.2},
      [&](const Intersection&, const Motion&, const PairQuery&, const Found& found, const Found& fresh) {
        ASSERT_EQ(found.pairs, fresh.pairs);
        ASSERT_EQ(found.waiting, fresh.waiting);
        for (std::size_t k = 0; k < found.pairs.size(); ++k)
          ASSERT_EQ(found.separations[k].distance, fresh.separations[k].distance);
        waiting += found.waiting.size(), acting += found.pairs.size();
      });
  EXPECT_GT(waiting, 10000u);
  EXPECT_GT(acting, 10000u);
}

/// A far throw that is taken back, and an obstacle that goes and returns: what was kept before is taken
/// again.
TEST(ClosePairs, DoNotDependOnRoundsWithoutWhatIsKept) {
  std::size_t acting = 0, waiting = 0, thrown = 0;
  Random random;
  const auto moved = [&](const Vec3Field& from, double most) {
    Motion motion = random_motion(from, most, random);
    motion.reach = 0.03, motion.own_reach = 0.05, motion.margin = 0.0005;
    return motion;
  };
  for (int trial = 0; trial < 20; ++trial) {
    SCOPED_TRACE(trial);
    Intersection meeting = random_meeting(random);
    const Sheet& sheet = meeting.sheet;
    const std::vector<Pose> poses = poses_at_begin(meeting);
    std::vector<PoseInterpolation> still;
    for (const Pose& pose : poses) still.emplace_back(Vec3::Zero(), pose, pose);
    ClosePairs keeping(sheet.surface, sheet.position, meeting.bodies, true, 0.02);
    Vec3Field position = sheet.position;
    for (int step = 0; step < 10; ++step) {
      const bool is_far = still.empty() || step % 2 == 0;
      std::vector<PoseInterpolation> paths = still;
      if (!is_far)
        paths[0] = PoseInterpolation(meeting.bodies[0].pivot, poses[0],
                                     {poses[0].rotation, poses[0].translation + random.vector(0.1)});
      const SweptBounds without = moved(position, is_far ? 0.3 : 0.0005).swept();
      thrown += Found(keeping, {position, without, paths, poses}).pairs.size();
      const Motion motion = moved(position, 0.0005);
      const SweptBounds swept = motion.swept();
      const PairQuery now{motion.from, swept, still, poses};
      ClosePairs anew(sheet.surface, sheet.position, meeting.bodies, true, 0.02);
      const Found found(keeping, now), fresh(anew, now);
      ASSERT_EQ(found.pairs, fresh.pairs);
      ASSERT_EQ(found.waiting, fresh.waiting);
      for (std::size_t k = 0; k < found.pairs.size(); ++k)
        ASSERT_EQ(found.separations[k].distance, fresh.separations[k].distance);
      acting += found.pairs.size(), waiting += found.waiting.size();
      position = motion.to;
    }
  }
  EXPECT_GT(acting, 1000u);
  EXPECT_GT(waiting, 1000u);
  EXPECT_GT(thrown, 1000u);
}

TEST(ClosePairs, ThatWaitAreNoContactsAndKeepHalfTheirDistance) {
  std::size_t looked = 0;
  find_on_walks({.wide = 10}, [&](const Intersection& meeting, const Motion& motion, const PairQuery& now,
                                  const Found& found, const Found& fresh) {
    ASSERT_EQ(found.pairs, fresh.pairs);
    ASSERT_EQ(found.waiting, fresh.waiting);
    std::size_t last = 0;
    for (const auto& [pair, place] : found.waiting) {
      ASSERT_LE(last, place);
      ASSERT_LE(place, found.pairs.size());
      last = place;
      const double reach = pair.obstacle == FeaturePair::cloth_itself ? motion.own_reach : motion.reach;
      const Separation s = separate(pair, {meeting.sheet.surface, motion.from, meeting.bodies, now.poses},
                                    near_factor * reach);
      ASSERT_FALSE(is_contact(s, reach));
      ASSERT_GE(least_distance(pair, meeting.sheet.surface, motion, meeting.bodies, meeting.paths),
                0.5 * s.distance);
      ++looked;
    }
  });
  EXPECT_GT(looked, 1000u);
}

}  // namespace
}  // namespace cloth::test::close_pairs_test
