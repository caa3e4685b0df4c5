// The search for near pairs against a look at all pairs of features: nothing that could meet is missed,
// nothing comes twice, and what hierarchies keep from one search to the next changes no answer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "contact/close_pairs.h"
#include "contact/obstacle_body.h"
#include "geometry/at.h"
#include "kernels/worker_team.h"
#include "scene/builtin_scenes.h"
#include "scene/obstacle_shape.h"
#include "support/contact_bodies.h"

namespace cloth::test::near_pairs_test {
namespace {

/// Every particle goes its way evenly within the step and keeps this far from the border of its capsule.
struct Motion {
  Vec3Field from, to;
  double margin = 0;                // m
  double reach = 0, own_reach = 0;  // m

  SweptBounds swept() const {
    SweptBounds swept{.reach = reach, .own_reach = own_reach};
    for (std::size_t i = 0; i < from.size(); ++i) swept.particles.push_back({from[i], to[i], margin});
    return swept;
  }
  Vec3 at(int i, double part) const {
    const auto n = static_cast<std::size_t>(i);
    return (1 - part) * from[n] + part * to[n];
  }
};

Motion random_motion(const Vec3Field& from, double furthest, Random& random) {
  Motion motion{from, from, random.uniform(0, 0.01), random.uniform(0, 0.01), random.uniform(0, 0.01)};
  for (std::size_t i = 0; i < from.size(); ++i) motion.to.add(i, random.vector(furthest));
  return motion;
}

double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  if (a.size() == 1 && b.size() == 3)
    return std::sqrt(closest_on_triangle(a[0], b[0], b[1], b[2]).squared_distance);
  if (a.size() == 3) return distance(b, a);
  return std::sqrt(closest_of_segments(a[0], a[1], b[0], b[1]).squared_distance);
}

double distance_to_obstacle(const FeaturePair& pair, const std::vector<Vec3>& near, const ObstacleBody& body,
                            const Pose& pose) {
  if (pair.kind == PairKind::vertex_plane)
    return (pose.rotation * body.normal).dot(near[0] - pose.at(body.point));
  if (pair.kind == PairKind::vertex_box)
    return closest_on_box(near[0], {pose.at(body.box.center), pose.rotation * body.box.axes,
                                    body.box.half.cwiseProduct(pose.stretch)})
        .distance;
  if (pair.kind == PairKind::face_sphere)
    return distance(near, {pose.at(body.center)}) - pose.stretch.x() * body.radius;
  std::vector<Vec3> far = far_points(pair, body);
  for (Vec3& point : far) point = pose.at(point);
  return distance(near, far);
}

std::vector<int> far_particles(const FeaturePair& pair, const Surface& cloth) {
  if (pair.kind == PairKind::edge_edge)
    return {cloth.edges[at(pair.far_feature)][0], cloth.edges[at(pair.far_feature)][1]};
  const auto& [a, b, c] = cloth.triangles[at(pair.far_feature)];
  return {a, b, c};
}

/// The least distance that the features of a pair are seen to have within the step, in m.
double least_distance(const FeaturePair& pair, const Surface& cloth, const Motion& motion,
                      const std::vector<ObstacleBody>& bodies, const std::vector<PoseInterpolation>& paths) {
  constexpr int moments = 6;
  const auto points = [&](const std::vector<int>& particles, double part) {
    std::vector<Vec3> all;
    for (const int i : particles) all.push_back(motion.at(i, part));
    return all;
  };
  double least = HUGE_VAL;
  for (int n = 0; n <= moments; ++n) {
    const double part = static_cast<double>(n) / moments;
    const std::vector<Vec3> near = points(near_particles(pair, cloth), part);
    least = std::min(least, pair.obstacle == FeaturePair::cloth_itself
                                ? distance(near, points(far_particles(pair, cloth), part))
                                : distance_to_obstacle(pair, near, bodies[at(pair.obstacle)],
                                                       paths[at(pair.obstacle)].at(part)));
  }
  return least;
}

/// Own edges are a pair either way round.
FeaturePair told_one_way(FeaturePair pair) {
  if (pair.obstacle == FeaturePair::cloth_itself && pair.kind == PairKind::edge_edge &&
      pair.far_feature < pair.feature)
    std::swap(pair.feature, pair.far_feature);
  return pair;
}

std::set<FeaturePair> told_apart(const std::vector<FeaturePair>& pairs) {
  std::set<FeaturePair> set;
  for (const FeaturePair& pair : pairs) set.insert(told_one_way(pair));
  return set;
}

struct Intersection {
  std::vector<ObstacleBody> bodies;
  std::vector<PoseInterpolation> paths;
  Sheet sheet;
};

Intersection random_meeting(Random& random) {
  Intersection meeting;
  meeting.sheet = random_sheet(random.integer(3, 6), random.integer(3, 6), random);
  for (const ObstacleShape* one : obstacle_shapes()) {
    if (random.coin()) continue;
    meeting.bodies.push_back(random_body(one, random));
    meeting.paths.push_back(random_interpolation(meeting.bodies.back(), random));
  }
  return meeting;
}

/// Whether a pair comes within reach of each other on its way, or could at the borders of its capsules.
bool comes_near(const FeaturePair& pair, const Intersection& meeting, const Motion& motion,
                double* distance) {
  *distance = least_distance(pair, meeting.sheet.surface, motion, meeting.bodies, meeting.paths);
  return *distance < (pair.obstacle == FeaturePair::cloth_itself ? motion.own_reach + 2 * motion.margin
                                                                 : motion.reach + motion.margin);
}

struct Looked {
  std::size_t near = 0, far = 0;
};

void expect_none_missed(const std::vector<FeaturePair>& pairs, const Intersection& meeting,
                        const Motion& motion, Looked& looked, bool with_itself = true) {
  const std::set<FeaturePair> found = told_apart(pairs);
  for (const FeaturePair& pair : all_pairs(meeting.sheet.surface, meeting.bodies, with_itself)) {
    double distance = 0;
    const bool near = comes_near(pair, meeting, motion, &distance);
    ++(near ? looked.near : looked.far);
    if (!near) continue;
    ASSERT_TRUE(found.contains(pair))
        << "obstacle " << pair.obstacle << ", kind " << static_cast<int>(pair.kind) << ", " << pair.feature
        << " and " << pair.far_feature << " come as near as " << distance << " m";
  }
}

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

/// Forty steps, mostly small ones, in which reach and obstacles change now and then.
template <class Look>
void walk(Random& random, const Look& look) {
  Intersection meeting = random_meeting(random);
  Motion motion{meeting.sheet.position, meeting.sheet.position, 0.003, 0.005, 0.005};
  look(meeting, motion, true);
  for (int step = 0; step < 40; ++step) {
    const double reach = motion.reach;
    motion = random_motion(motion.to, random.integer(0, 9) == 0 ? 0.05 : 0.002, random);
    const int change = random.integer(0, 30);
    motion.reach = motion.own_reach = change == 0 ? random.uniform(0.001, 0.01) : reach;
    motion.margin = 0.0005;
    if (change < 3 && !meeting.bodies.empty())
      meeting.paths[0] = random_interpolation(meeting.bodies[0], random);
    look(meeting, motion, false);
    if (::testing::Test::HasFatalFailure()) return;
  }
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
    for (std::size_t i = 0; i < sheet.position.size(); ++i) {
      const Vec3 at = sheet.position[i] + 0.01 * place * Vec3(1, 1, 1);
      swept.particles.push_back({at, at, i % 6 == 0 ? 0.03 : 0.001});
    }
    PairSearch keeping(sheet.surface, sheet.position, none, true, 0);
    std::vector<FeaturePair> pairs, fresh;
    keeping.find(swept, {}, pairs);
    for (std::size_t i = 0; i < swept.particles.size(); i += 6) {
      const Vec3 moved = swept.particles[i].from + Vec3::Constant(0.015);
      swept.particles[i] = {moved, moved, 0.001};
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
}  // namespace cloth::test::near_pairs_test
