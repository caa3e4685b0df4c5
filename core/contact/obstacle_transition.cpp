#include "contact/obstacle_transition.h"

#include <algorithm>
#include <optional>

#include "contact/obstacle_entry.h"
#include "scene/obstacle_shape.h"

namespace cloth {
namespace {

double left_of_transition(double begin, double time) {
  const double end = begin + transition_time;
  if (time <= begin) return 1;
  if (time >= end) return 0;
  return (end - time) / transition_time;
}

/// What an obstacle was before an edit. Where obstacles came or went only an equal one is known again.
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

/// From what an obstacle now is to what it was, in the pose that it had.
ObstacleTransition transition_from(const Obstacle& then, const Pose& pose_then, const Obstacle& now,
                                   double time) {
  const Pose pose_now = pose_of(now, time);
  ObstacleTransition transition{.way = pose_then.at(pivot_of(then)) - pose_now.at(pivot_of(now)),
                                .begin = time};
  transition.stretch = pose_then.stretch.cwiseProduct(shape_of(now).stretch_between(now, then));
  if (shape_of(now).body != BodyKind::ball)  // whose turn nothing has to follow
    transition.turn =
        rotation_of(pose_now.turn.transpose() * pose_then.turn * shape_of(now).turn_between(now, then));
  return transition;
}

}  // namespace

double ObstacleTransition::left(double time) const {
  return left_of_transition(begin, time);
}

double ThicknessTransition::left(double time) const {
  return left_of_transition(begin, time);
}

double ObstacleTransition::speed(double reach) const {
  const double turning = std::max(1.0, stretch.maxCoeff()) * turn.norm(),
               growing = (stretch - Vec3::Ones()).cwiseAbs().maxCoeff();
  return (way.norm() + reach * (turning + growing)) / transition_time;
}

Pose pose_in_transition(const std::vector<Obstacle>& obstacles, const ObstacleTransitions& transitions,
                        std::size_t obstacle, double time) {
  Pose pose = pose_of(obstacles[obstacle], time);
  if (transitions.empty()) return pose;
  const ObstacleTransition& transition = transitions[obstacle];
  const double left = transition.is_active() ? transition.left(time) : 0;
  if (left == 0) return pose;
  pose.shift += left * transition.way;
  if (!transition.reshapes()) return pose;
  const Vec3 pivot = pivot_of(obstacles[obstacle]);
  return about(pivot, pose.turn * turn_by(left * transition.turn), pose.at(pivot),
               Vec3::Ones() + left * (transition.stretch - Vec3::Ones()));
}

ThicknessTransition thickness_after(const Scene& before, const ThicknessTransition& transition,
                                    const Scene& after, double time) {
  const auto of = [](const Scene& scene) { return scene.contact.value_or(ContactSettings{}).thickness; };
  ThicknessTransition result{.missing = of(after) - of(before) + transition.left(time) * transition.missing,
                             .begin = time};
  if (before.self_contact && after.self_contact)
    result.own_missing = after.self_contact->thickness - before.self_contact->thickness +
                         transition.left(time) * transition.own_missing;
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
      result[k] = before.transitions[*earlier];  // on its way already
    any = any || result[k].is_active();
  }
  return any ? result : ObstacleTransitions{};
}

}  // namespace cloth
