// Poses of obstacles (rotation, translation and, after an edit of their size, stretch; see
// contact/obstacle_transition.h) and the interpolation between two poses.
#pragma once

#include <algorithm>

#include "params/parameter.h"

namespace cloth {

/// The map x -> rotation (stretch x) + translation from the coordinates in which the scene describes an
/// obstacle to the world.
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< a rotation matrix
  Vec3 translation{0, 0, 0};                               ///< m
  Vec3 stretch{1, 1, 1};  ///< factor along each axis, > 0; only a box's may differ

  Vec3 at(const Vec3& point) const { return rotation * point.cwiseProduct(stretch) + translation; }
  Vec3 inverse(const Vec3& point) const {
    return (rotation.transpose() * (point - translation)).cwiseQuotient(stretch);
  }
  bool operator==(const Pose&) const = default;
};

/// The pose with this rotation and stretch that maps `pivot` to `pivot_now` (m).
Pose about(const Vec3& pivot, const Eigen::Matrix3d& rotation, const Vec3& pivot_now,
           const Vec3& stretch = Vec3::Ones());

/// The rotation matrix of a rotation vector (rad along the axis), and the rotation vector, of at most pi, of
/// a matrix.
Eigen::Matrix3d rotation_matrix(const Vec3& rotation);
Vec3 rotation_vector(const Eigen::Matrix3d& rotation);

/// Interpolates between two poses: the pivot moves along a straight line, the rotation angle about a fixed
/// axis and the stretch change linearly.
class PoseInterpolation {
 public:
  PoseInterpolation() = default;
  /// Rotates by the smaller angle; if the obstacle spins by `spun` (rad along the axis) in between, by as
  /// many whole turns more as come nearest to it.
  PoseInterpolation(const Vec3& pivot, const Pose& from, const Pose& to, const Vec3& spun = Vec3::Zero());

  Pose at(double part) const;  ///< `part` in [0, 1]; at 0 and 1 the given poses to the bit
  bool is_still() const { return from_ == to_ && angle_ == 0; }
  double angle() const { return angle_; }  ///< rad, >= 0
  bool grows() const { return from_.stretch != to_.stretch; }
  /// Upper bound of the change of a point's distance from the pivot by the stretch, divided by that distance.
  double growth() const { return (to_.stretch - from_.stretch).cwiseAbs().maxCoeff(); }
  double largest_stretch() const { return std::max(from_.stretch.maxCoeff(), to_.stretch.maxCoeff()); }
  double least_stretch() const { return std::min(from_.stretch.minCoeff(), to_.stretch.minCoeff()); }
  const Pose& from() const { return from_; }
  const Pose& to() const { return to_; }
  Vec3 pivot(double part) const { return pivot_from_ + part * (pivot_to_ - pivot_from_); }  ///< m

 private:
  void add_whole_turns(const Vec3& spun);

  Pose from_, to_;
  Vec3 pivot_{0, 0, 0}, pivot_from_{0, 0, 0}, pivot_to_{0, 0, 0};
  Vec3 axis_{0, 1, 0};
  double angle_ = 0;
};

}  // namespace cloth
