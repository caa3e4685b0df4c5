#include "contact/obstacle_carry.h"

#include <algorithm>
#include <optional>

namespace cloth {
namespace {

/// What an obstacle was before an edit. Where obstacles came or went only an equal one is known again.
std::optional<std::size_t> earlier_self(const std::vector<Obstacle>& before,
                                        const std::vector<Obstacle>& after, std::size_t k) {
  if (before.size() == after.size())
    return before[k].shape == after[k].shape ? std::optional(k) : std::nullopt;
  const auto found = std::find(before.begin(), before.end(), after[k]);
  if (found == before.end()) return std::nullopt;
  return static_cast<std::size_t>(found - before.begin());
}

Vec3 pivot_at(const std::vector<Obstacle>& obstacles, const ObstacleCarries& carries, std::size_t k,
              double time) {
  return carried_pose(obstacles, carries, k, time).at(pivot_of(obstacles[k]));
}

}  // namespace

Vec3 ObstacleCarry::shift(double time) const {
  if (time <= begin) return way;
  if (time >= end()) return Vec3::Zero();
  return (end() - time) / carry_time * way;
}

Pose carried_pose(const std::vector<Obstacle>& obstacles, const ObstacleCarries& carries,
                  std::size_t obstacle, double time) {
  Pose pose = pose_of(obstacles[obstacle], time);
  if (!carries.empty() && carries[obstacle].carries()) pose.shift += carries[obstacle].shift(time);
  return pose;
}

ObstacleCarries carries_after(const std::vector<Obstacle>& before, const std::vector<Obstacle>& after,
                              const ObstacleCarries& carries, double time) {
  if (carries.empty() && before == after) return {};
  ObstacleCarries result(after.size());
  bool any = false;
  for (std::size_t k = 0; k < after.size(); ++k) {
    const auto earlier = earlier_self(before, after, k);
    if (!earlier) continue;
    if (after[k] == before[*earlier]) {
      if (!carries.empty()) result[k] = carries[*earlier];  // on its way already
    } else {
      result[k] = {pivot_at(before, carries, *earlier, time) - pivot_at(after, {}, k, time), time};
    }
    any = any || result[k].carries();
  }
  return any ? result : ObstacleCarries{};
}

}  // namespace cloth
