#include "contact/obstacle_transition.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "contact/obstacle_body.h"
#include "contact/start_check.h"
#include "geometry/at.h"

namespace cloth {
namespace {

double remaining_part(double begin, double time) {
  const double end = begin + transition_time;
  if (time <= begin) return 1;
  if (time >= end) return 0;
  return (end - time) / transition_time;
}

/// The point of the cloth that is nearest to a given one.
struct Nearest {
  Vec3 separation{0, 0, 0};    ///< m, from the cloth to the given point
  Vec3 normal{0, 1, 0};        ///< of the cloth there, of length one
  double distance = infinity;  ///< m
};

Nearest nearest_of(const TriangleMesh& cloth, const Vec3& place) {
  Nearest nearest;
  for (const Triangle& t : cloth.triangles) {
    const Vec3 &a = cloth.vertices[at(t[0])], &b = cloth.vertices[at(t[1])], &c = cloth.vertices[at(t[2])];
    const PointTriangle closest = closest_on_triangle(place, a, b, c);
    const double distance = std::sqrt(closest.squared_distance);
    if (distance >= nearest.distance) continue;
    nearest = {closest.separation, (b - a).cross(c - a).normalized(), distance};
  }
  return nearest;
}

/// m, by which a plane must be lowered for all of the cloth to lie `thickness` above it.
double depth_of(const TriangleMesh& cloth, const Vec3& point, const Vec3& normal, double thickness) {
  double depth = 0;
  for (const Vec3& vertex : cloth.vertices) depth = std::max(depth, normal.dot(point - vertex));
  return depth + thickness;
}

/// The transition by which an obstacle that an edit has added enters the cloth. It starts at a size at which
/// it does not touch the cloth, grows to its full size and so pushes the cloth aside; a plane rises from
/// below the cloth. No transition if the obstacle does not touch the cloth. `thickness` (m): where the pivot
/// lies on the cloth, the obstacle starts at this distance.
ObstacleTransition entry_of(const Obstacle& obstacle, const TriangleMesh& cloth, double thickness,
                            double time) {
  const Pose pose = pose_of(obstacle, time);
  ObstacleTransition transition{.begin = time};
  if (!touches(cloth, obstacle, pose)) return transition;
  const Vec3 pivot = pivot_of(obstacle), place = pose.at(pivot);
  if (shape_of(obstacle).body == BodyKind::half_space) {
    const Vec3 normal = pose.rotation * obstacle.normal.normalized();
    transition.displacement = -depth_of(cloth, place, normal, thickness) * normal;
    return transition;
  }
  for (const double size : {0.98, 0.95, 0.9, 0.8, 0.6, 0.4, 0.2, 0.1, 0.05, 0.02}) {
    transition.stretch = Vec3::Constant(size);
    if (!touches(cloth, obstacle, about(pivot, pose.rotation, place, transition.stretch))) return transition;
  }
  // The pivot lies on the cloth or very near it: the obstacle starts on the pivot's side.
  const Nearest there = nearest_of(cloth, place);
  transition.displacement =
      there.normal.dot(there.separation) < 0 ? -thickness * there.normal : thickness * there.normal;
  const double room = nearest_of(cloth, place + transition.displacement).distance;
  transition.stretch = Vec3::Constant(0.5 * std::min(1.0, room / body_of(obstacle).reach));
  return transition;
}

/// The index that an obstacle had before an edit. Where obstacles were added or removed, only an equal one is
/// recognised; none: the obstacle is new, or of another shape.
std::optional<std::size_t> earlier_self(const ObstaclesBefore& before, const std::vector<Obstacle>& after,
                                        std::size_t k) {
  if (before.poses.empty()) return std::nullopt;
  const std::vector<Obstacle>& obstacles = before.obstacles;
  if (obstacles.size() == after.size()) {
    const bool same_body = obstacles[k].shape == after[k].shape &&
                           (!shape_of(after[k]).is_from_file || obstacles[k].mesh == after[k].mesh);
    return same_body ? std::optional(k) : std::nullopt;
  }
  const auto found = std::find(obstacles.begin(), obstacles.end(), after[k]);
  if (found == obstacles.end()) return std::nullopt;
  return static_cast<std::size_t>(found - obstacles.begin());
}

/// The transition from an obstacle before an edit, in the pose that it had, to the obstacle after it.
ObstacleTransition transition_from(const Obstacle& then, const Pose& pose_then, const Obstacle& now,
                                   double time) {
  const Pose pose_now = pose_of(now, time);
  ObstacleTransition transition{.displacement = pose_then.at(pivot_of(then)) - pose_now.at(pivot_of(now)),
                                .begin = time};
  transition.stretch = pose_then.stretch.cwiseProduct(shape_of(now).stretch_between(now, then));
  if (shape_of(now).body != BodyKind::ball)  // whose rotation has no effect
    transition.rotation = rotation_vector(pose_now.rotation.transpose() * pose_then.rotation *
                                          shape_of(now).rotation_between(now, then));
  return transition;
}

}  // namespace

double ObstacleTransition::remaining(double time) const {
  return remaining_part(begin, time);
}

double ThicknessTransition::remaining(double time) const {
  return remaining_part(begin, time);
}

double ObstacleTransition::speed(double reach) const {
  const double rotating = std::max(1.0, stretch.maxCoeff()) * rotation.norm(),
               growing = (stretch - Vec3::Ones()).cwiseAbs().maxCoeff();
  return (displacement.norm() + reach * (rotating + growing)) / transition_time;
}

Pose pose_in_transition(const std::vector<Obstacle>& obstacles, const ObstacleTransitions& transitions,
                        std::size_t obstacle, double time) {
  Pose pose = pose_of(obstacles[obstacle], time);
  if (transitions.empty()) return pose;
  const ObstacleTransition& transition = transitions[obstacle];
  const double remaining = transition.is_active() ? transition.remaining(time) : 0;
  if (remaining == 0) return pose;
  pose.translation += remaining * transition.displacement;
  if (!transition.reshapes()) return pose;
  const Vec3 pivot = pivot_of(obstacles[obstacle]);
  return about(pivot, pose.rotation * rotation_matrix(remaining * transition.rotation), pose.at(pivot),
               Vec3::Ones() + remaining * (transition.stretch - Vec3::Ones()));
}

ThicknessTransition thickness_after(const Scene& before, const ThicknessTransition& transition,
                                    const Scene& after, double time) {
  const auto of = [](const Scene& scene) { return scene.contact.value_or(ContactSettings{}).thickness; };
  ThicknessTransition result{
      .missing = of(after) - of(before) + transition.remaining(time) * transition.missing, .begin = time};
  if (before.self_contact && after.self_contact)
    result.own_missing = after.self_contact->thickness - before.self_contact->thickness +
                         transition.remaining(time) * transition.own_missing;
  result.missing = std::max(result.missing, 0.0), result.own_missing = std::max(result.own_missing, 0.0);
  return result;
}

ObstacleTransitions transitions_after(const ObstaclesBefore& before, const Scene& after, double time,
                                      const TriangleMesh& cloth) {
  const std::vector<Obstacle>& obstacles = after.obstacles;
  ObstacleTransitions result(obstacles.size());
  bool any = false;
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const auto earlier = earlier_self(before, obstacles, k);
    if (!earlier)
      result[k] = entry_of(obstacles[k], cloth, after.contact.value_or(ContactSettings{}).thickness, time);
    else if (obstacles[k] != before.obstacles[*earlier])
      result[k] = transition_from(before.obstacles[*earlier], before.poses[*earlier], obstacles[k], time);
    else if (!before.transitions.empty())
      result[k] = before.transitions[*earlier];  // already in transition
    any = any || result[k].is_active();
  }
  return any ? result : ObstacleTransitions{};
}

}  // namespace cloth
