// The body of an obstacle for contact, in its own coordinates: the place and size that the scene file gives,
// before any motion. A Pose maps them to the world.
#pragma once

#include <cstdint>
#include <vector>

#include "contact/surface.h"
#include "geometry/bounds.h"
#include "geometry/closest_points.h"
#include "scene/obstacle_motion.h"
#include "scene/obstacle_shape.h"

namespace cloth {

struct ObstacleBody {
  BodyKind kind = BodyKind::ball;
  Vec3 pivot{0, 0, 0};         ///< m, centre of its rotation, see pivot_of()
  Vec3 center{0, 0, 0};        ///< m, of a ball
  double radius = 0;           ///< m, of a ball
  Vec3 point{0, 0, 0};         ///< m, on the plane that bounds a half space
  Vec3 normal{0, 1, 0};        ///< outward unit normal of a half space
  OrientedBox box;             ///< of a box
  std::vector<Vec3> vertices;  ///< m, of a surface; the corners of a box
  Surface surface;             ///< connectivity of a surface; of a box only its edges
  double reach = 0;            ///< m, largest distance of its points from the pivot; 0 for a half space
  double friction = 0;         ///< coefficient; factor of the velocity with response "reflect"
  double restitution = 0;      ///< rebound speed over approach speed
  bool reflects = false;       ///< response "reflect"
};

ObstacleBody body_of(const Obstacle& obstacle);

/// Upper bound of the length of the path of any point of the body, in m; infinite for a half space that
/// rotates.
double longest_path(const ObstacleBody& body, const PoseInterpolation& path);

/// Whether the body is at the same place in both poses; the rotation of a sphere does not matter.
bool same_place(const ObstacleBody& body, const Pose& a, const Pose& b);

/// Into how many equal substeps contact divides a step in which the bodies follow these paths; 1 for most
/// steps. A separating plane is valid for small rotations only, and a fast triangle mesh sweeps over too many
/// features. `edge`: mean length of the cloth's edges, in m.
std::int64_t substeps_for(const std::vector<ObstacleBody>& bodies,
                          const std::vector<PoseInterpolation>& paths, double edge);

/// Whether the body may come within `reach` metres of a box around the cloth; a test of bounding boxes.
bool comes_near(const ObstacleBody& body, const PoseInterpolation& path, const Bounds& cloth, double reach);

}  // namespace cloth
