// The user's input to a running simulation: the wind brush and the pull. Plain values, which are sent between
// threads and logged.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/vec3_field.h"

namespace cloth {

/// A gust of the wind brush (report, section 4.4). A particle at distance r in pixels from the cursor feels
/// cos(pi/2 * r/radius) of `velocity`, nothing outside the radius. Needs air in the scene to act.
struct BrushGust {
  Vec3 velocity{0, 0, 0};  ///< m/s, in the world
  Eigen::Matrix4d world_to_screen =
      Eigen::Matrix4d::Identity();  ///< homogeneous, to pixels (x right, y down)
  Eigen::Vector2d cursor{0, 0};     ///< pixels
  double radius = 80;               ///< pixels
};

/// A spring of rest length zero from one particle to the cursor's point in the world.
struct Pull {
  int particle = 0;
  Vec3 target{0, 0, 0};  ///< m
};

}  // namespace cloth
