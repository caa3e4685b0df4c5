#include "params/field_builders.h"
#include "scene/obstacle_shape.h"

namespace cloth {
namespace {

class BoxShape final : public ObstacleShape {
 public:
  BoxShape()
      : ObstacleShape({Shape::box, "box", "Box", "A cube or rectangle under the cloth.", BodyKind::box}) {}

  Fields<Obstacle> fields() const override {
    return {vector(&Obstacle::center, place_info("center", "Centre", "Centre of the box.")),
            vector(&Obstacle::size, {.key = "size",
                                     .label = "Size",
                                     .unit = "m",
                                     .doc = "Full lengths of the box along x, y and z.",
                                     .minimum = 0,
                                     .minimum_excluded = true,
                                     .slider_minimum = 0.01,
                                     .slider_maximum = 2})};
  }
  Vec3& place(Obstacle& box) const override { return box.center; }
  void start(Obstacle& box, const Vec3& middle, double span) const override {
    box.size = Vec3::Constant(0.4 * span);
    box.center = middle - Vec3(0, 0.75 * span, 0);
  }
  Eigen::AlignedBox3d bounds(const Obstacle& box) const override {
    return {box.center - box.size / 2, box.center + box.size / 2};
  }
  double thickness(const Obstacle& box) const override { return box.size.minCoeff(); }
  Vec3 stretch_between(const Obstacle& from, const Obstacle& to) const override {
    return to.size.cwiseQuotient(from.size);
  }
};

}  // namespace

const ObstacleShape& box_shape() {
  static const BoxShape shape;
  return shape;
}

}  // namespace cloth
