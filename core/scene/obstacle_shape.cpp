#include "scene/obstacle_shape.h"

namespace cloth {

const std::vector<const ObstacleShape*>& obstacle_shapes() {
  static const std::vector<const ObstacleShape*> shapes{&sphere_shape(), &box_shape(), &plane_shape(),
                                                        &mesh_shape()};
  return shapes;
}

Eigen::AlignedBox3d ObstacleShape::bounds_at(const Obstacle& obstacle, const Pose& pose) const {
  const Eigen::AlignedBox3d home = bounds(obstacle);
  Eigen::AlignedBox3d moved;
  for (int k = 0; k < 8 && !home.isEmpty(); ++k)
    moved.extend(pose.at(home.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k))));
  return moved;
}

std::optional<SurfacePoint> ObstacleShape::entry(const Obstacle& obstacle, const Vec3& /*from*/,
                                                 const Vec3& point) const {
  return penetration(obstacle, point);
}

std::optional<SurfacePoint> ObstacleShape::along(const Obstacle&, const Vec3&, const Vec3&) const {
  return std::nullopt;
}

void ObstacleShape::grow(Obstacle&, double) const {}

bool ObstacleShape::touches(const Obstacle&, const Pose&, const Corners&) const {
  return false;
}

TriangleMesh placed_mesh(const Obstacle& obstacle) {
  const PlacedSurface surface = shape_of(obstacle).surface(obstacle);
  TriangleMesh mesh = *surface.mesh;
  const Eigen::Matrix3d turn = surface.rotation * surface.scale.asDiagonal();
  for (Vec3& vertex : mesh.vertices) vertex = surface.place + turn * vertex;
  return mesh;
}

ParameterInfo place_info(const char* key, const char* label, const char* doc) {
  return {.key = key, .label = label, .unit = "m", .doc = doc, .slider_minimum = -2, .slider_maximum = 2};
}

}  // namespace cloth
