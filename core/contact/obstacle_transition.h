// How an obstacle gets to what an edit has made of it. Under continuous contact it may not just be there:
// cloth could lie in between. So the edit takes effect at once, and from it the obstacle is drawn aside,
// turned and stretched to where and what it was; this fades away evenly, and contact sees an obstacle that
// moves, turns and grows.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"
#include "scene/obstacle_motion.h"

namespace cloth {

/// s of simulated time, from an edit to the obstacle's arrival.
inline constexpr double transition_time = 0.05;

struct ObstacleTransition {
  Vec3 way{0, 0, 0};      ///< m, of the pivot, from the scene's place to where the obstacle was at `begin`
  double begin = 0;       ///< s
  Vec3 turn{0, 0, 0};     ///< rad along the axis, before the scene's turn
  Vec3 stretch{1, 1, 1};  ///< at `begin`

  double end() const { return begin + transition_time; }
  bool is_active() const { return !way.isZero(0) || reshapes(); }
  bool reshapes() const { return !turn.isZero(0) || stretch != Vec3::Ones(); }
  double left(double time) const;  ///< of all of it: 1 until `begin`, 0 from `end` on
  /// m/s, at most, of any point within `reach` metres of the pivot.
  double speed(double reach) const;
};

/// What is missing of the thicknesses that an edit has made larger: they grow to what the scene says.
struct ThicknessTransition {
  double missing = 0, own_missing = 0;  ///< m, at `begin`: to obstacles, and of the cloth to itself
  double begin = 0;                     ///< s

  bool is_active() const { return missing > 0 || own_missing > 0; }
  double left(double time) const;  ///< see ObstacleTransition
};

/// Of `before`, with what is left of an earlier edit, by an edit at `time`, in s.
ThicknessTransition thickness_after(const Scene& before, const ThicknessTransition& transition,
                                    const Scene& after, double time);

/// One for each obstacle; empty: none is carried.
using ObstacleTransitions = std::vector<ObstacleTransition>;

/// Where an obstacle is, carried or not.
Pose pose_in_transition(const std::vector<Obstacle>& obstacles, const ObstacleTransitions& transitions,
                        std::size_t obstacle, double time);

/// Obstacles as they are, with the way that is left of earlier edits.
struct ObstaclesBefore {
  const std::vector<Obstacle>& obstacles;
  const std::vector<Pose>& poses;  ///< empty: of obstacles that were not followed continuously
  const ObstacleTransitions& transitions;
};

/// What an edit at `time`, in s, makes of the carries in force: every obstacle that both scenes have stays
/// where it is, and as it is, for now. Others are at once what the scene says, unless that touches the
/// cloth, see entry_of().
ObstacleTransitions transitions_after(const ObstaclesBefore& before, const Scene& after, double time,
                                      const TriangleMesh& cloth);

}  // namespace cloth
