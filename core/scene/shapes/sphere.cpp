#include <cmath>

#include "geometry/closest_points.h"
#include "params/field_builders.h"
#include "scene/obstacle_shape.h"

namespace cloth {
namespace {

class SphereShape final : public ObstacleShape {
 public:
  SphereShape() : ObstacleShape({"sphere", "Sphere", "A ball under the cloth.", BodyKind::ball}) {}

  Fields<Obstacle> fields() const override {
    return {field(&Obstacle::center, place_info("center", "Centre", "Centre of the sphere.")),
            field(&Obstacle::radius, positive({.key = "radius",
                                               .label = "Radius",
                                               .unit = "m",
                                               .doc = "Radius of the sphere.",
                                               .slider_minimum = 0.01}))};
  }
  Vec3& place(Obstacle& sphere) const override { return sphere.center; }
  void start(Obstacle& sphere, const Vec3& middle, double span) const override {
    sphere.radius = 0.25 * span;
    sphere.center = middle - Vec3(0, 0.75 * span, 0);
  }
  Eigen::AlignedBox3d bounds(const Obstacle& sphere) const override { return bounds_at(sphere, {}); }
  /// However it turns; as large as the scene says.
  Eigen::AlignedBox3d bounds_at(const Obstacle& sphere, const Pose& pose) const override {
    const Vec3 half = Vec3::Constant(sphere.radius), center = pose.at(sphere.center);
    return {center - half, center + half};
  }
  double thickness(const Obstacle& sphere) const override { return 2 * sphere.radius; }
  Vec3 stretch_between(const Obstacle& from, const Obstacle& to) const override {
    return Vec3::Constant(to.radius / from.radius);
  }
  std::optional<SurfacePoint> penetration(const Obstacle& sphere, const Vec3& point) const override {
    const Vec3 out = point - sphere.center;
    const double squared = out.squaredNorm();
    if (!(squared < sphere.radius * sphere.radius)) return std::nullopt;
    // The centre itself is equally far from every point of the surface: up is as good as any.
    const Vec3 normal = squared > 0 ? Vec3(out / std::sqrt(squared)) : Vec3(0, 1, 0);
    return SurfacePoint{sphere.center + sphere.radius * normal, normal};
  }
  std::optional<SurfacePoint> along(const Obstacle& sphere, const Vec3& normal,
                                    const Vec3& point) const override {
    const Vec3 out = point - sphere.center;
    const double distance = out.norm();
    const Vec3 up = distance > 0 ? Vec3(out / distance) : normal;
    return SurfacePoint{sphere.center + sphere.radius * up, up};
  }
  void grow(Obstacle& sphere, double length) const override { sphere.radius += length; }
  bool touches(const Obstacle& sphere, const Pose& pose, const Corners& t) const override {
    const auto closest = closest_on_triangle(pose.at(sphere.center), t[0], t[1], t[2]);
    const double radius = pose.stretch.x() * sphere.radius;
    return closest.squared_distance <= radius * radius;
  }
};

}  // namespace

const ObstacleShape& sphere_shape() {
  static const SphereShape shape;
  return shape;
}

}  // namespace cloth
