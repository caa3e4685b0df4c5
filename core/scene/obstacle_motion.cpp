#include "scene/obstacle_motion.h"

#include <algorithm>
#include <cmath>

#include "scene/obstacle_shape.h"

namespace cloth {
namespace {

Pose pose_between(const Vec3& pivot, const std::vector<Keyframe>& keys, double time) {
  const auto pose_at_key = [&](const Keyframe& key) {
    return about(pivot, rotation_matrix(key.rotation), key.position);
  };
  const auto next =
      std::find_if(keys.begin(), keys.end(), [&](const Keyframe& key) { return key.time > time; });
  if (next == keys.begin()) return pose_at_key(keys.front());
  if (next == keys.end()) return pose_at_key(keys.back());
  const Keyframe& last = *std::prev(next);
  return PoseInterpolation(pivot, pose_at_key(last), pose_at_key(*next))
      .at((time - last.time) / (next->time - last.time));
}

}  // namespace

Vec3 pivot_of(const Obstacle& obstacle) {
  return shape_of(obstacle).place(const_cast<Obstacle&>(obstacle));
}

bool moves(const Obstacle& obstacle) {
  return !obstacle.velocity.isZero(0) || !obstacle.spin.isZero(0) || !obstacle.keyframes.empty();
}

Pose pose_of(const Obstacle& obstacle, double time) {
  if (!moves(obstacle)) return {};
  const Vec3 pivot = pivot_of(obstacle);
  if (!obstacle.keyframes.empty()) return pose_between(pivot, obstacle.keyframes, time);
  return about(pivot, rotation_matrix(time * obstacle.spin), pivot + time * obstacle.velocity);
}

double highest_speed(const Obstacle& obstacle, double reach) {
  double highest = obstacle.velocity.norm() + reach * obstacle.spin.norm();
  if (obstacle.keyframes.empty()) return highest;
  highest = 0;
  for (std::size_t k = 1; k < obstacle.keyframes.size(); ++k) {
    const Keyframe &a = obstacle.keyframes[k - 1], &b = obstacle.keyframes[k];
    const Eigen::AngleAxisd turn(rotation_matrix(b.rotation) * rotation_matrix(a.rotation).transpose());
    highest = std::max(
        highest, ((b.position - a.position).norm() + reach * std::abs(turn.angle())) / (b.time - a.time));
  }
  return highest;
}

}  // namespace cloth
