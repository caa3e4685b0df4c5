// Bounding boxes of a frame's cloth and obstacles, for framing the camera and for placing the ground.
#pragma once

#include <Eigen/Geometry>

#include "bridge/frame.h"

namespace clothlab {

/// In m. Planes are infinite and are ignored.
Eigen::AlignedBox3d bounds_of_cloth(const ClothFrame& frame);
Eigen::AlignedBox3d bounds_of_obstacles(const ClothFrame& frame);

/// Bounds of the obstacles at the start and at all their keyframes (m).
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
