#include "support/pair_search.h"

#include <algorithm>
#include <cmath>

#include "geometry/at.h"
#include "scene/obstacle_shape.h"

namespace cloth::test {

Motion random_motion(const Vec3Field& from, double furthest, Random& random) {
  Motion motion{from, from, random.uniform(0, 0.01), random.uniform(0, 0.01), random.uniform(0, 0.01)};
  for (std::size_t i = 0; i < from.size(); ++i) motion.to.add(i, random.vector(furthest));
  return motion;
}

static double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  if (a.size() == 1 && b.size() == 3)
    return std::sqrt(closest_on_triangle(a[0], b[0], b[1], b[2]).squared_distance);
  if (a.size() == 3) return distance(b, a);
  return std::sqrt(closest_of_segments(a[0], a[1], b[0], b[1]).squared_distance);
}

static double distance_to_obstacle(const FeaturePair& pair, const std::vector<Vec3>& near,
                                   const ObstacleBody& body, const Pose& pose) {
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
static FeaturePair told_one_way(FeaturePair pair) {
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
static bool comes_near(const FeaturePair& pair, const Intersection& meeting, const Motion& motion,
                       double* distance) {
  *distance = least_distance(pair, meeting.sheet.surface, motion, meeting.bodies, meeting.paths);
  return *distance < (pair.obstacle == FeaturePair::cloth_itself ? motion.own_reach + 2 * motion.margin
                                                                 : motion.reach + motion.margin);
}

void expect_none_missed(const std::vector<FeaturePair>& pairs, const Intersection& meeting,
                        const Motion& motion, Looked& looked, bool with_itself) {
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

}  // namespace cloth::test
