#include "geometry/rigid_motion.h"

#include <cmath>
#include <numbers>

namespace cloth {

Pose about(const Vec3& pivot, const Eigen::Matrix3d& turn, const Vec3& pivot_now, const Vec3& stretch) {
  return {turn, pivot_now - turn * pivot.cwiseProduct(stretch), stretch};
}

Eigen::Matrix3d rotation_matrix(const Vec3& rotation) {
  const double angle = rotation.norm();
  if (!(angle > 0)) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
}

Vec3 rotation_vector(const Eigen::Matrix3d& turn) {
  if (turn.isIdentity(0)) return Vec3::Zero();
  const Eigen::AngleAxisd rotation(turn);
  return rotation.angle() * rotation.axis();
}

PoseInterpolation::PoseInterpolation(const Vec3& pivot, const Pose& from, const Pose& to, const Vec3& spun)
    : from_(from), to_(to), pivot_(pivot), pivot_from_(from.at(pivot)), pivot_to_(to.at(pivot)) {
  if (from.rotation != to.rotation) {
    const Eigen::AngleAxisd turn(to.rotation * from.rotation.transpose());
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
  if (angle_ == 0)
    return {from_.rotation, from_.translation + part * (to_.translation - from_.translation), stretch};
  return about(pivot_, Eigen::AngleAxisd(part * angle_, axis_).toRotationMatrix() * from_.rotation,
               pivot(part), stretch);
}

}  // namespace cloth
