// The search for near pairs against a look at all pairs of features: nothing that could meet is missed,
// nothing comes twice, and what hierarchies keep from one search to the next changes no answer.
#include "contact/near_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "support/contact_bodies.h"

namespace cloth::test {
namespace {

std::size_t at(int index) {
  return static_cast<std::size_t>(index);
}

/// Every particle goes its way evenly within the step and keeps this far from the border of its box.
struct Ways {
  Vec3Field from, to;
  double margin = 0;  // m

  std::vector<Bounds> boxes() const {
    std::vector<Bounds> boxes;
    for (std::size_t i = 0; i < from.size(); ++i) boxes.push_back(bounds_of(from[i], to[i]).grown(margin));
    return boxes;
  }
  Vec3 at(int i, double part) const {
    const auto n = static_cast<std::size_t>(i);
    return (1 - part) * from[n] + part * to[n];
  }
};

Ways random_ways(const Vec3Field& from, double furthest, Random& random) {
  Ways ways{from, from, random.uniform(0, 0.01)};
  for (std::size_t i = 0; i < from.size(); ++i) ways.to.add(i, random.vector(furthest));
  return ways;
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
    return (pose.turn * body.normal).dot(near[0] - pose.at(body.point));
  if (pair.kind == PairKind::vertex_box) return closest_on_box(pose.back(near[0]), body.box).distance;
  if (pair.kind == PairKind::face_sphere) return distance(near, {pose.at(body.center)}) - body.radius;
  std::vector<Vec3> far = foreign_points(pair, body);
  for (Vec3& point : far) point = pose.at(point);
  return distance(near, far);
}

std::vector<int> foreign_particles(const FeaturePair& pair, const Surface& cloth) {
  if (pair.kind == PairKind::edge_edge)
    return {cloth.edges[at(pair.foreign)][0], cloth.edges[at(pair.foreign)][1]};
  const auto& [a, b, c] = cloth.triangles[at(pair.foreign)];
  return {a, b, c};
}

/// The least distance that the features of a pair are seen to have within the step, in m.
double least_distance(const FeaturePair& pair, const Surface& cloth, const Ways& ways,
                      const std::vector<ObstacleBody>& bodies, const std::vector<Passage>& passages) {
  constexpr int moments = 6;
  const auto points = [&](const std::vector<int>& particles, double part) {
    std::vector<Vec3> all;
    for (const int i : particles) all.push_back(ways.at(i, part));
    return all;
  };
  double least = HUGE_VAL;
  for (int n = 0; n <= moments; ++n) {
    const double part = static_cast<double>(n) / moments;
    const std::vector<Vec3> near = points(particles_of(pair, cloth), part);
    least = std::min(least, pair.obstacle == FeaturePair::cloth_itself
                                ? distance(near, points(foreign_particles(pair, cloth), part))
                                : distance_to_obstacle(pair, near, bodies[at(pair.obstacle)],
                                                       passages[at(pair.obstacle)].at(part)));
  }
  return least;
}

/// Own edges are a pair either way round.
FeaturePair told_one_way(FeaturePair pair) {
  if (pair.obstacle == FeaturePair::cloth_itself && pair.kind == PairKind::edge_edge &&
      pair.foreign < pair.feature)
    std::swap(pair.feature, pair.foreign);
  return pair;
}

std::set<FeaturePair> told_apart(const std::vector<FeaturePair>& pairs) {
  std::set<FeaturePair> set;
  for (const FeaturePair& pair : pairs) set.insert(told_one_way(pair));
  return set;
}

struct Meeting {
  std::vector<ObstacleBody> bodies;
  std::vector<Passage> passages;
  Sheet sheet;
};

Meeting random_meeting(Random& random) {
  Meeting meeting;
  meeting.sheet = random_sheet(random.integer(3, 6), random.integer(3, 6), random);
  for (const Shape shape : all_shapes) {
    if (random.coin()) continue;
    meeting.bodies.push_back(random_body(shape, random));
    meeting.passages.push_back(random_passage(meeting.bodies.back(), random));
  }
  return meeting;
}

TEST(NearPairs, MissNoneOfAllPairsThatComeNear) {
  Random random;
  std::size_t near = 0, far = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Meeting meeting = random_meeting(random);
    const Surface& cloth = meeting.sheet.surface;
    const Ways ways = random_ways(meeting.sheet.position, random.coin() ? 0.01 : 0.1, random);
    const double reach = random.uniform(0, 0.01);
    std::vector<FeaturePair> pairs;
    PairSearch(cloth, meeting.bodies, true, 0.02).find(ways.boxes(), meeting.passages, reach, pairs);
    const std::set<FeaturePair> found = told_apart(pairs);
    for (const FeaturePair& pair : all_pairs(cloth, meeting.bodies, true)) {
      const bool itself = pair.obstacle == FeaturePair::cloth_itself;
      const double distance = least_distance(pair, cloth, ways, meeting.bodies, meeting.passages);
      if (!(distance < (itself ? 2 * ways.margin : reach + ways.margin))) {
        ++far;
        continue;
      }
      ++near;
      ASSERT_TRUE(found.contains(pair))
          << "trial " << trial << ": obstacle " << pair.obstacle << ", kind " << static_cast<int>(pair.kind)
          << ", " << pair.feature << " and " << pair.foreign << " come as near as " << distance << " m";
    }
  }
  EXPECT_GT(near, 2000u);
  EXPECT_GT(far, 50 * near) << "hardly anything could have been left out";
}

TEST(NearPairs, ComeOnceAndAreOfFeaturesThatExist) {
  Random random;
  for (int trial = 0; trial < 60; ++trial) {
    const Meeting meeting = random_meeting(random);
    const Ways ways = random_ways(meeting.sheet.position, 0.05, random);
    std::vector<FeaturePair> pairs;
    PairSearch(meeting.sheet.surface, meeting.bodies, true, 0.02)
        .find(ways.boxes(), meeting.passages, 0.005, pairs);
    const std::set<FeaturePair> found = told_apart(pairs);
    EXPECT_EQ(found.size(), pairs.size()) << "some came twice";
    const std::vector<FeaturePair> all = all_pairs(meeting.sheet.surface, meeting.bodies, true);
    const std::set<FeaturePair> known = told_apart(all);
    EXPECT_TRUE(std::includes(known.begin(), known.end(), found.begin(), found.end()));
  }
}

TEST(NearPairs, OfBoxesFarApartAreNone) {
  Random random;
  Meeting meeting;
  meeting.sheet = random_sheet(4, 4, random);
  for (const Shape shape : {Shape::sphere, Shape::box, Shape::mesh}) {
    meeting.bodies.push_back(random_body(shape, random));
    meeting.passages.emplace_back(Vec3::Zero(), Pose{}, Pose{});
    meeting.passages.back() = Passage(meeting.bodies.back().pivot, {Eigen::Matrix3d::Identity(), {0, 9, 0}},
                                      {Eigen::Matrix3d::Identity(), {3, 5, 0}});
  }
  std::vector<FeaturePair> pairs{FeaturePair{}};
  PairSearch(meeting.sheet.surface, meeting.bodies, false, 0)
      .find(random_ways(meeting.sheet.position, 0, random).boxes(), meeting.passages, 0.01, pairs);
  EXPECT_TRUE(pairs.empty());
}

TEST(NearPairs, DoNotDependOnWhatEarlierSearchesKept) {
  Random random;
  std::size_t compared = 0;
  for (int trial = 0; trial < 20; ++trial) {
    Meeting meeting = random_meeting(random);
    constexpr double skin = 0.02;
    PairSearch keeping(meeting.sheet.surface, meeting.bodies, true, skin);
    Ways ways{meeting.sheet.position, meeting.sheet.position, 0.003};
    double reach = 0.005;
    for (int step = 0; step < 40; ++step) {
      ways =
          random_ways(ways.to, random.integer(0, 9) == 0 ? 0.05 : 0.002, random);  // mostly within the skin
      const int change = random.integer(0, 30);
      if (change == 0) reach = random.uniform(0, 0.01);
      if (change < 3 && !meeting.bodies.empty())
        meeting.passages[0] = random_passage(meeting.bodies[0], random);
      std::vector<FeaturePair> pairs, fresh;
      keeping.find(ways.boxes(), meeting.passages, reach, pairs);
      PairSearch(meeting.sheet.surface, meeting.bodies, true, skin)
          .find(ways.boxes(), meeting.passages, reach, fresh);
      ASSERT_EQ(told_apart(pairs), told_apart(fresh)) << "trial " << trial << ", step " << step;
      ASSERT_EQ(pairs.size(), fresh.size());
      compared += pairs.size();
    }
  }
  EXPECT_GT(compared, 10000u);
}

}  // namespace
}  // namespace cloth::test
