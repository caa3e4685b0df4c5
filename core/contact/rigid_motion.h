// Where an obstacle is: a function of time alone.
#pragma once

#include "scene/scene.h"

namespace cloth {

/// x -> turn x + shift, from where the scene describes an obstacle to where it is.
struct Pose {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vec3 shift{0, 0, 0};  ///< m

  Vec3 at(const Vec3& point) const { return turn * point + shift; }
  Vec3 back(const Vec3& point) const { return turn.transpose() * (point - shift); }
  bool operator==(const Pose&) const = default;
};

/// The point about which an obstacle spins: centre of a sphere or box, point of a plane, origin of a placed
/// mesh. In m, before any motion.
Vec3 pivot_of(const Obstacle& obstacle);

bool moves(const Obstacle& obstacle);

/// `time` in s.
Pose pose_of(const Obstacle& obstacle, double time);

/// m/s, at most, of any point within `reach` metres of the pivot, at any time.
double highest_speed(const Obstacle& obstacle, double reach);

/// From one pose to another: the pivot on a straight line, the turn evenly about one axis, the short way.
class Passage {
 public:
  Passage() = default;
  Passage(const Vec3& pivot, const Pose& from, const Pose& to);

  Pose at(double part) const;  ///< in [0, 1]; the ends are the given poses to the bit
  bool rests() const { return from_ == to_; }
  double angle() const { return angle_; }  ///< rad, >= 0
  const Pose& from() const { return from_; }
  const Pose& to() const { return to_; }
  Vec3 pivot(double part) const { return pivot_from_ + part * (pivot_to_ - pivot_from_); }  ///< m

 private:
  Pose from_, to_;
  Vec3 pivot_{0, 0, 0}, pivot_from_{0, 0, 0}, pivot_to_{0, 0, 0};
  Vec3 axis_{0, 1, 0};
  double angle_ = 0;
};

}  // namespace cloth
