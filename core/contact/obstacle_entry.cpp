#include "contact/obstacle_entry.h"

#include <algorithm>
#include <cmath>

#include "contact/obstacle_body.h"
#include "contact/start_check.h"
#include "geometry/closest_points.h"

namespace cloth {
namespace {

Vec3 corner(const TriangleMesh& cloth, const Triangle& triangle, std::size_t k) {
  return cloth.vertices[static_cast<std::size_t>(triangle[k])];
}

struct Nearest {
  Vec3 separation{0, 0, 0};  ///< m, from the cloth
  Vec3 normal{0, 1, 0};      ///< of the cloth there, of length one
  double distance = infinity;
};

Nearest nearest_of(const TriangleMesh& cloth, const Vec3& place) {
  Nearest nearest;
  for (const Triangle& t : cloth.triangles) {
    const Vec3 a = corner(cloth, t, 0), b = corner(cloth, t, 1), c = corner(cloth, t, 2);
    const PointTriangle closest = closest_on_triangle(place, a, b, c);
    const double distance = std::sqrt(closest.squared_distance);
    if (distance >= nearest.distance) continue;
    nearest = {closest.separation, (b - a).cross(c - a).normalized(), distance};
  }
  return nearest;
}

/// m, by which a plane must go back for all of the cloth to lie `thickness` above it.
double depth_of(const TriangleMesh& cloth, const Vec3& point, const Vec3& normal, double thickness) {
  double depth = 0;
  for (const Vec3& vertex : cloth.vertices) depth = std::max(depth, normal.dot(point - vertex));
  return depth + thickness;
}

}  // namespace

ObstacleTransition entry_of(const Obstacle& obstacle, const TriangleMesh& cloth, double thickness,
                            double time) {
  const Pose pose = pose_of(obstacle, time);
  ObstacleTransition transition{.begin = time};
  if (!touches(cloth, obstacle, pose)) return transition;
  const Vec3 pivot = pivot_of(obstacle), place = pose.at(pivot);
  if (shape_of(obstacle).body == BodyKind::half_space) {
    const Vec3 normal = pose.turn * obstacle.normal.normalized();
    transition.way = -depth_of(cloth, place, normal, thickness) * normal;
    return transition;
  }
  for (const double size : {0.98, 0.95, 0.9, 0.8, 0.6, 0.4, 0.2, 0.1, 0.05, 0.02}) {
    transition.stretch = Vec3::Constant(size);
    if (!touches(cloth, obstacle, about(pivot, pose.turn, place, transition.stretch))) return transition;
  }
  // Its middle is in the cloth, or hardly beside it: it begins on the side where that is.
  const Nearest there = nearest_of(cloth, place);
  transition.way =
      there.normal.dot(there.separation) < 0 ? -thickness * there.normal : thickness * there.normal;
  const double room = nearest_of(cloth, place + transition.way).distance;
  transition.stretch = Vec3::Constant(0.5 * std::min(1.0, room / body_of(obstacle).reach));
  return transition;
}

}  // namespace cloth
