// The handle by which an obstacle is moved: a ring for the plane of the screen, three arrows for the axes.
// Geometry only, without widgets or OpenGL.
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
      80;  ///< px; the handle is shown within this distance even if the cursor is not over the obstacle

  int obstacle = 0;
  Eigen::Vector3d place{0, 0, 0};  ///< m; the obstacle's centre or point, as the scene defines it

  std::array<Eigen::Vector3d, 3> tips(const Camera& camera) const;  ///< m, of the arrows
  Part part_at(const Camera& camera, const Eigen::Vector2d& cursor) const;
};

/// The obstacle moved by `by` (m): changes its keyframes if it has any, else its centre, point or position.
cloth::Obstacle moved_by(const cloth::Obstacle& obstacle, const Eigen::Vector3d& by);

/// Whether the obstacle's position changes with time, so that a drag moves its whole path.
bool has_motion(const cloth::Obstacle& obstacle);

/// The handle to be shown for a cursor, in px: of the obstacle whose handle is nearest, or which is under it.
std::optional<ObstacleHandle> handle_at(const ClothFrame& frame, const Camera& camera,
                                        const Eigen::Vector2d& cursor);

/// m: how far the obstacle is dragged from `handle.place` by a cursor that went from `start` to `now`.
Eigen::Vector3d dragged_by(const ObstacleHandle& handle, ObstacleHandle::Part part, const Camera& camera,
                           const Eigen::Vector2d& start, const Eigen::Vector2d& now);

}  // namespace clothlab
