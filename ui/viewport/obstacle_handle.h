// The handle by which an obstacle is moved: a ring for the plane of the screen, three arrows for the axes.
// Plain mathematics without widgets or OpenGL.
#pragma once

#include <array>
#include <optional>

#include "bridge/frame.h"
#include "viewport/camera.h"

namespace clothlab {

struct ObstacleHandle {
  enum class Part { none, ring, x, y, z };

  static constexpr double ring_radius = 11, arrow_length = 58;  ///< px
  static constexpr double nearness =
      80;  ///< px: so far from its place it is shown without the obstacle under it

  int obstacle = 0;
  Eigen::Vector3d place{0, 0, 0};  ///< m, where the scene means the obstacle's centre or point to be

  std::array<Eigen::Vector3d, 3> tips(const Camera& camera) const;  ///< m, of the arrows
  Part part_at(const Camera& camera, const Eigen::Vector2d& cursor) const;
};

/// The obstacle, moved by so many metres: its keyframes where it has some, for they say where it is; else its
/// centre, point or position, from which it may move on.
cloth::Obstacle moved_by(const cloth::Obstacle& obstacle, const Eigen::Vector3d& by);

/// Whether its place is another at another time, so that a drag moves a whole motion.
bool has_motion(const cloth::Obstacle& obstacle);

/// The handle to be shown for a cursor, in px: of the obstacle whose handle is nearest, or which is under it.
std::optional<ObstacleHandle> handle_at(const ClothFrame& frame, const Camera& camera,
                                        const Eigen::Vector2d& cursor);

/// m: how far the obstacle is dragged from `handle.place` by a cursor that went from `start` to `now`.
Eigen::Vector3d dragged_by(const ObstacleHandle& handle, ObstacleHandle::Part part, const Camera& camera,
                           const Eigen::Vector2d& start, const Eigen::Vector2d& now);

}  // namespace clothlab
