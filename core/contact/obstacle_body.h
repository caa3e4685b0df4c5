// An obstacle as contact knows it: its shape where the scene describes it, before any motion.
#pragma once

#include <vector>

#include "contact/surface.h"
#include "geometry/closest_points.h"
#include "scene/obstacle_motion.h"
#include "scene/obstacle_shape.h"

namespace cloth {

struct ObstacleBody {
  BodyKind kind = BodyKind::ball;
  Vec3 pivot{0, 0, 0};
  Vec3 center{0, 0, 0};        ///< m, of a sphere
  double radius = 0;           ///< m
  Vec3 point{0, 0, 0};         ///< m, of a plane
  Vec3 normal{0, 1, 0};        ///< of length one
  OrientedBox box;             ///< of a box
  std::vector<Vec3> vertices;  ///< m, of a mesh; the corners of a box
  Surface surface;             ///< of a mesh; of a box only the edges
  double reach = 0;            ///< m, of its furthest point from the pivot; of a plane 0
  double friction = 0, restitution = 0;
  bool reflects = false;  ///< response "reflect"
};

ObstacleBody body_of(const Obstacle& obstacle);

}  // namespace cloth
