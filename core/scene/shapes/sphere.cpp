#include "params/field_builders.h"
#include "scene/obstacle_shape.h"

namespace cloth {
namespace {

class SphereShape final : public ObstacleShape {
 public:
  SphereShape()
      : ObstacleShape({Shape::sphere, "sphere", "Sphere", "A ball under the cloth.", BodyKind::ball}) {}

  Fields<Obstacle> fields() const override {
    return {vector(&Obstacle::center, place_info("center", "Centre", "Centre of the sphere.")),
            number(&Obstacle::radius, {.key = "radius",
                                       .label = "Radius",
                                       .unit = "m",
                                       .doc = "Radius of the sphere.",
                                       .minimum = 0,
                                       .minimum_excluded = true,
                                       .slider_minimum = 0.01,
                                       .slider_maximum = 1})};
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
};

}  // namespace

const ObstacleShape& sphere_shape() {
  static const SphereShape shape;
  return shape;
}

}  // namespace cloth
