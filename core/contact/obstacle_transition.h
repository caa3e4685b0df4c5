// Transitions of obstacles after an edit. Under continuous contact an obstacle must not change abruptly,
// because cloth could lie between its old and its new place. An edit therefore takes effect at once, together
// with a correction (displacement, rotation, stretch) that keeps the obstacle as it was. The correction
// decreases linearly to zero within transition_time, and contact sees an obstacle that moves, rotates and
// grows.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"
#include "scene/obstacle_motion.h"

namespace cloth {

/// s of simulated time, from an edit until the obstacle is as the scene says.
inline constexpr double transition_time = 0.05;

/// The correction of an obstacle's pose at `begin`.
struct ObstacleTransition {
  Vec3 displacement{0, 0, 0};  ///< m, of the pivot: from its place in the scene to that before the edit
  double begin = 0;            ///< s
  Vec3 rotation{0, 0, 0};      ///< rad along the axis, applied before the rotation of the scene
  Vec3 stretch{1, 1, 1};       ///< along the axes of the body

  bool is_active() const { return !displacement.isZero(0) || reshapes(); }
  bool reshapes() const { return !rotation.isZero(0) || stretch != Vec3::Ones(); }
  /// The part of the correction at `time` (s): 1 until `begin`, 0 after transition_time.
  double remaining(double time) const;
  /// m/s, upper bound of the speed of any point within `reach` metres of the pivot.
  double speed(double reach) const;
};

/// After an edit that has increased thicknesses, these grow linearly to their values in the scene.
struct ThicknessTransition {
  double missing = 0, own_missing = 0;  ///< m at `begin`, of the thickness to obstacles and in self-contact
  double begin = 0;                     ///< s

  bool is_active() const { return missing > 0 || own_missing > 0; }
  double remaining(double time) const;  ///< see ObstacleTransition
};

/// The transition after an edit at `time` (s) that replaces `before`, whose transition may still be active.
ThicknessTransition thickness_after(const Scene& before, const ThicknessTransition& transition,
                                    const Scene& after, double time);

/// One for each obstacle, or none where no transition is active.
using ObstacleTransitions = std::vector<ObstacleTransition>;

/// The pose of an obstacle at `time` (s), corrected by its transition.
Pose pose_in_transition(const std::vector<Obstacle>& obstacles, const ObstacleTransitions& transitions,
                        std::size_t obstacle, double time);

/// The obstacles before an edit, their present poses, and the transitions of earlier edits.
struct ObstaclesBefore {
  const std::vector<Obstacle>& obstacles;
  const std::vector<Pose>& poses;  ///< empty without continuous contact
  const ObstacleTransitions& transitions;
};

/// The transitions after an edit at `time` (s). An obstacle that both scenes have keeps its present pose for
/// the moment. A new obstacle is at once as the scene says; if it touches the cloth there, it grows into its
/// place instead, or, if it is a plane, rises from below the cloth.
ObstacleTransitions transitions_after(const ObstaclesBefore& before, const Scene& after, double time,
                                      const TriangleMesh& cloth);

}  // namespace cloth
