#include <algorithm>
#include <cmath>

#include "params/field_builders.h"
#include "scene/obstacle_shape.h"

namespace cloth {
namespace {

/// The rotation by the least angle that takes one direction to the other. As Eigen's FromTwoVectors, but that
/// any axis across will do where they are opposite: Eigen finds one by a singular value decomposition, which
/// takes longer to compile than the rest of the room.
Eigen::Matrix3d least_rotation(const Vec3& from, const Vec3& to) {
  const double cosine = std::max(-1.0, to.dot(from)), half = std::sqrt((1 + cosine) / 2);
  Eigen::Quaterniond rotation;
  rotation.w() = half;
  if (cosine < -1 + 1e-12)
    rotation.vec() = std::sqrt(1 - half * half) * from.unitOrthogonal();
  else
    rotation.vec() = from.cross(to) * (1 / (2 * half));
  return rotation.toRotationMatrix();
}

class PlaneShape final : public ObstacleShape {
 public:
  PlaneShape() : ObstacleShape({"plane", "Plane", "A floor under the cloth.", BodyKind::half_space}) {}

  Fields<Obstacle> fields() const override {
    return {field(&Obstacle::point, place_info("point", "Point", "A point of the plane.")),
            field(&Obstacle::normal, {.key = "normal",
                                      .label = "Normal",
                                      .doc = "Outward direction of the plane.",
                                      .unit_vector = true,
                                      .slider_minimum = -1})};
  }
  Vec3& place(Obstacle& plane) const override { return plane.point; }
  void start(Obstacle& plane, const Vec3& middle, double span) const override {
    plane.point = middle - Vec3(0, 1.25 * span, 0);
  }
  Eigen::AlignedBox3d bounds(const Obstacle&) const override { return {}; }
  Vec3 stretch_between(const Obstacle&, const Obstacle&) const override { return Vec3::Ones(); }
  Eigen::Matrix3d rotation_between(const Obstacle& from, const Obstacle& to) const override {
    if (from.normal == to.normal) return Eigen::Matrix3d::Identity();
    return least_rotation(from.normal.normalized(), to.normal.normalized());
  }
  std::optional<SurfacePoint> penetration(const Obstacle& plane, const Vec3& point) const override {
    const Vec3 normal = plane.normal.normalized();
    const double height = normal.dot(point - plane.point);
    if (!(height < 0)) return std::nullopt;
    return SurfacePoint{point - height * normal, normal};
  }
  std::optional<SurfacePoint> along(const Obstacle& plane, const Vec3& normal,
                                    const Vec3& point) const override {
    return SurfacePoint{point - normal.dot(point - plane.point) * normal, normal};
  }
  void grow(Obstacle& plane, double length) const override {
    plane.point += length * plane.normal.normalized();
  }
  bool touches(const Obstacle& plane, const Pose& pose, const Corners& triangle) const override {
    const Vec3 normal = pose.rotation * plane.normal.normalized(), point = pose.at(plane.point);
    return std::any_of(triangle.begin(), triangle.end(),
                       [&](const Vec3& x) { return normal.dot(x - point) <= 0; });
  }
};

}  // namespace

const ObstacleShape& plane_shape() {
  static const PlaneShape shape;
  return shape;
}

}  // namespace cloth
