#include "contact/rigid_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cloth {
namespace {

Pose pose_between(const Vec3& pivot, const std::vector<Keyframe>& keys, double time) {
  const auto pose_at_key = [&](const Keyframe& key) {
    return about(pivot, turn_by(key.rotation), key.position);
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

Pose about(const Vec3& pivot, const Eigen::Matrix3d& turn, const Vec3& pivot_now, const Vec3& stretch) {
  return {turn, pivot_now - turn * pivot.cwiseProduct(stretch), stretch};
}

Eigen::Matrix3d turn_by(const Vec3& rotation) {
  const double angle = rotation.norm();
  if (!(angle > 0)) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
}

Vec3 rotation_of(const Eigen::Matrix3d& turn) {
  if (turn.isIdentity(0)) return Vec3::Zero();
  const Eigen::AngleAxisd both(turn);
  return both.angle() * both.axis();
}

Vec3 pivot_of(const Obstacle& obstacle) {
  switch (obstacle.shape) {
    case Shape::plane:
      return obstacle.point;
    case Shape::mesh:
      return obstacle.translate;
    case Shape::sphere:
    case Shape::box:
      break;
  }
  return obstacle.center;
}

bool moves(const Obstacle& obstacle) {
  return !obstacle.velocity.isZero(0) || !obstacle.spin.isZero(0) || !obstacle.keyframes.empty();
}

Pose pose_of(const Obstacle& obstacle, double time) {
  if (!moves(obstacle)) return {};
  const Vec3 pivot = pivot_of(obstacle);
  if (!obstacle.keyframes.empty()) return pose_between(pivot, obstacle.keyframes, time);
  return about(pivot, turn_by(time * obstacle.spin), pivot + time * obstacle.velocity);
}

double highest_speed(const Obstacle& obstacle, double reach) {
  double highest = obstacle.velocity.norm() + reach * obstacle.spin.norm();
  if (obstacle.keyframes.empty()) return highest;
  highest = 0;
  for (std::size_t k = 1; k < obstacle.keyframes.size(); ++k) {
    const Keyframe &a = obstacle.keyframes[k - 1], &b = obstacle.keyframes[k];
    const Eigen::AngleAxisd turn(turn_by(b.rotation) * turn_by(a.rotation).transpose());
    highest = std::max(
        highest, ((b.position - a.position).norm() + reach * std::abs(turn.angle())) / (b.time - a.time));
  }
  return highest;
}

PoseInterpolation::PoseInterpolation(const Vec3& pivot, const Pose& from, const Pose& to, const Vec3& spun)
    : from_(from), to_(to), pivot_(pivot), pivot_from_(from.at(pivot)), pivot_to_(to.at(pivot)) {
  if (from.turn != to.turn) {
    const Eigen::AngleAxisd turn(to.turn * from.turn.transpose());
    angle_ = turn.angle();
    axis_ = turn.axis();
  }
  if (spun.norm() > std::numbers::pi) add_whole_turns(spun);
}

void PoseInterpolation::add_whole_turns(const Vec3& spun) {
  constexpr double whole = 2 * std::numbers::pi, rounding = 1e-9;
  if (angle_ < rounding || whole - angle_ < rounding) axis_ = spun.normalized();
  angle_ += whole * std::round((spun.dot(axis_) - angle_) / whole);
  if (angle_ >= 0) return;
  angle_ = -angle_;
  axis_ = -axis_;
}

Pose PoseInterpolation::at(double part) const {
  if (part <= 0) return from_;
  if (part >= 1) return to_;
  const Vec3 stretch = from_.stretch + part * (to_.stretch - from_.stretch);
  if (angle_ == 0) return {from_.turn, from_.shift + part * (to_.shift - from_.shift), stretch};
  return about(pivot_, Eigen::AngleAxisd(part * angle_, axis_).toRotationMatrix() * from_.turn, pivot(part),
               stretch);
}

}  // namespace cloth
