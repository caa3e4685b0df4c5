// Rigid motion: turns and shifts, and the way from one to another; what an edit has made larger or smaller is
// stretched as well until it has its size (contact/obstacle_transition).
#pragma once

#include <algorithm>

#include "params/parameter.h"

namespace cloth {

/// x -> turn (stretch x) + shift, from where the scene describes an obstacle to where it is; `stretch` axis
/// by axis, the same along all of them but for boxes.
struct Pose {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vec3 shift{0, 0, 0};    ///< m
  Vec3 stretch{1, 1, 1};  ///< > 0

  Vec3 at(const Vec3& point) const { return turn * point.cwiseProduct(stretch) + shift; }
  Vec3 back(const Vec3& point) const { return (turn.transpose() * (point - shift)).cwiseQuotient(stretch); }
  bool operator==(const Pose&) const = default;
};

/// What puts `pivot` at `pivot_now`.
Pose about(const Vec3& pivot, const Eigen::Matrix3d& turn, const Vec3& pivot_now,
           const Vec3& stretch = Vec3::Ones());

/// A turn by |rotation| about it, in rad; and the rotation of a turn, the short way.
Eigen::Matrix3d turn_by(const Vec3& rotation);
Vec3 rotation_of(const Eigen::Matrix3d& turn);

/// From one pose to another: the pivot on a straight line, the turn evenly about one axis, the stretch
/// evenly.
class PoseInterpolation {
 public:
  PoseInterpolation() = default;
  /// The short way; but where the obstacle has turned by `spun`, in rad along the axis, on the way, by as
  /// many whole turns more as come nearest to that.
  PoseInterpolation(const Vec3& pivot, const Pose& from, const Pose& to, const Vec3& spun = Vec3::Zero());

  Pose at(double part) const;  ///< in [0, 1]; the ends are the given poses to the bit
  bool rests() const { return from_ == to_ && angle_ == 0; }
  double angle() const { return angle_; }  ///< rad, >= 0
  bool grows() const { return from_.stretch != to_.stretch; }
  /// By how much of its distance from the pivot a point is moved away from it, or towards it, at most.
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
