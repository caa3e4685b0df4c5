// How an obstacle gets to where an edit has put it. Under continuous contact it may not just be there: cloth
// could lie in between. So the edit takes effect at once, and from it the obstacle is drawn aside by the way
// that it was moved; this shift fades away evenly, and contact sees an obstacle that moves.
#pragma once

#include <vector>

#include "contact/rigid_motion.h"

namespace cloth {

/// s of simulated time, from an edit to the obstacle's arrival.
inline constexpr double carry_time = 0.05;

struct ObstacleCarry {
  Vec3 way{0, 0, 0};  ///< m, from the scene's place to where the obstacle was at `begin`
  double begin = 0;   ///< s

  double end() const { return begin + carry_time; }
  bool carries() const { return !way.isZero(0); }
  Vec3 shift(double time) const;  ///< m; all of `way` until `begin`, none from `end` on
  double speed() const { return way.norm() / carry_time; }  ///< m/s
};

/// One for each obstacle; empty: none is carried. Obstacles that turn or grow by an edit do so at once.
using ObstacleCarries = std::vector<ObstacleCarry>;

/// Where an obstacle is, carried or not.
Pose carried_pose(const std::vector<Obstacle>& obstacles, const ObstacleCarries& carries,
                  std::size_t obstacle, double time);

/// What an edit at `time`, in s, makes of the carries in force: every obstacle that both scenes have stays
/// where it is for now.
ObstacleCarries carries_after(const std::vector<Obstacle>& before, const std::vector<Obstacle>& after,
                              const ObstacleCarries& carries, double time);

}  // namespace cloth
