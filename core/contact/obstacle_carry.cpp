#include "contact/obstacle_carry.h"

#include <algorithm>
#include <optional>

#include "contact/obstacle_entry.h"

namespace cloth {
namespace {

double left_of_carry(double begin, double time) {
  const double end = begin + carry_time;
  if (time <= begin) return 1;
  if (time >= end) return 0;
  return (end - time) / carry_time;
}

/// What an obstacle was before an edit. Where obstacles came or went only an equal one is known again.
std::optional<std::size_t> earlier_self(const CarriedObstacles& before, const std::vector<Obstacle>& after,
                                        std::size_t k) {
  if (before.poses.empty()) return std::nullopt;
  const std::vector<Obstacle>& obstacles = before.obstacles;
  if (obstacles.size() == after.size()) {
    const bool same_body = obstacles[k].shape == after[k].shape &&
                           (after[k].shape != Shape::mesh || obstacles[k].mesh == after[k].mesh);
    return same_body ? std::optional(k) : std::nullopt;
  }
  const auto found = std::find(obstacles.begin(), obstacles.end(), after[k]);
  if (found == obstacles.end()) return std::nullopt;
  return static_cast<std::size_t>(found - obstacles.begin());
}

/// From the one as the scene describes it to the other, about their pivots.
Vec3 stretch_between(const Obstacle& from, const Obstacle& to) {
  switch (from.shape) {
    case Shape::sphere:
      return Vec3::Constant(to.radius / from.radius);
    case Shape::box:
      return to.size.cwiseQuotient(from.size);
    case Shape::mesh:
      return Vec3::Constant(to.scale / from.scale);
    case Shape::plane:
      break;
  }
  return Vec3::Ones();
}

Eigen::Matrix3d turn_between(const Obstacle& from, const Obstacle& to) {
  if (from.shape == Shape::plane && from.normal != to.normal)
    return Eigen::Quaterniond::FromTwoVectors(from.normal, to.normal).toRotationMatrix();
  if (from.shape == Shape::mesh && from.rotate != to.rotate) return turn_of(to) * turn_of(from).transpose();
  return Eigen::Matrix3d::Identity();
}

/// From what an obstacle now is to what it was, in the pose that it had.
ObstacleCarry carry_from(const Obstacle& then, const Pose& pose_then, const Obstacle& now, double time) {
  const Pose pose_now = pose_of(now, time);
  ObstacleCarry carry{.way = pose_then.at(pivot_of(then)) - pose_now.at(pivot_of(now)), .begin = time};
  carry.stretch = pose_then.stretch.cwiseProduct(stretch_between(now, then));
  if (now.shape != Shape::sphere)  // whose turn nothing has to follow
    carry.turn = rotation_of(pose_now.turn.transpose() * pose_then.turn * turn_between(now, then));
  return carry;
}

}  // namespace

double ObstacleCarry::left(double time) const {
  return left_of_carry(begin, time);
}

double ThicknessCarry::left(double time) const {
  return left_of_carry(begin, time);
}

double ObstacleCarry::speed(double reach) const {
  const double turning = std::max(1.0, stretch.maxCoeff()) * turn.norm(),
               growing = (stretch - Vec3::Ones()).cwiseAbs().maxCoeff();
  return (way.norm() + reach * (turning + growing)) / carry_time;
}

Pose carried_pose(const std::vector<Obstacle>& obstacles, const ObstacleCarries& carries,
                  std::size_t obstacle, double time) {
  Pose pose = pose_of(obstacles[obstacle], time);
  if (carries.empty()) return pose;
  const ObstacleCarry& carry = carries[obstacle];
  const double left = carry.carries() ? carry.left(time) : 0;
  if (left == 0) return pose;
  pose.shift += left * carry.way;
  if (!carry.reshapes()) return pose;
  const Vec3 pivot = pivot_of(obstacles[obstacle]);
  return about(pivot, pose.turn * turn_by(left * carry.turn), pose.at(pivot),
               Vec3::Ones() + left * (carry.stretch - Vec3::Ones()));
}

ThicknessCarry thickness_after(const Scene& before, const ThicknessCarry& carry, const Scene& after,
                               double time) {
  const auto of = [](const Scene& scene) { return scene.contact.value_or(ContactSettings{}).thickness; };
  ThicknessCarry result{.missing = of(after) - of(before) + carry.left(time) * carry.missing, .begin = time};
  if (before.self_contact && after.self_contact)
    result.own_missing =
        after.self_contact->thickness - before.self_contact->thickness + carry.left(time) * carry.own_missing;
  result.missing = std::max(result.missing, 0.0), result.own_missing = std::max(result.own_missing, 0.0);
  return result;
}

ObstacleCarries carries_after(const CarriedObstacles& before, const Scene& after, double time,
                              const TriangleMesh& cloth) {
  const std::vector<Obstacle>& obstacles = after.obstacles;
  ObstacleCarries result(obstacles.size());
  bool any = false;
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const auto earlier = earlier_self(before, obstacles, k);
    if (!earlier)
      result[k] = entry_of(obstacles[k], cloth, after.contact.value_or(ContactSettings{}).thickness, time);
    else if (obstacles[k] != before.obstacles[*earlier])
      result[k] = carry_from(before.obstacles[*earlier], before.poses[*earlier], obstacles[k], time);
    else if (!before.carries.empty())
      result[k] = before.carries[*earlier];  // on its way already
    any = any || result[k].carries();
  }
  return any ? result : ObstacleCarries{};
}

}  // namespace cloth
