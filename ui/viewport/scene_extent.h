// How much room the things of a frame take: for framing the camera and for laying the ground.
#pragma once

#include <Eigen/Geometry>

#include "bridge/frame.h"

namespace clothlab {

/// m. Planes are endless and do not count.
Eigen::AlignedBox3d bounds_of_cloth(const ClothFrame& frame);
Eigen::AlignedBox3d bounds_of_obstacles(const ClothFrame& frame);

/// Where obstacles start and wherever their keyframes lead them.
Eigen::AlignedBox3d reach_of_obstacles(const std::vector<cloth::Obstacle>& obstacles);

/// The cloth's bounds and, where it is pinned, how far down it can hang from its pins: every particle stays
/// within its distance in `frame` of the nearest pin. Meant for the first frame of a run, when the cloth is
/// flat.
Eigen::AlignedBox3d reach_of_cloth(const ClothFrame& frame);

struct Ground {
  double height = 0;         ///< m
  bool is_obstacle = false;  ///< a level plane of the scene lies there
};

/// The highest level plane among the obstacles, else a little below everything in `reach`.
Ground ground_below(const Eigen::AlignedBox3d& reach, const std::vector<cloth::Obstacle>& obstacles);

bool is_level(const cloth::Obstacle& obstacle);

}  // namespace clothlab
