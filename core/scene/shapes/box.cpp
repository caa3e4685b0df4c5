#include <algorithm>

#include "geometry/at.h"
#include "geometry/closest_points.h"
#include "params/field_builders.h"
#include "scene/obstacle_shape.h"

namespace cloth {
namespace {

constexpr double on_surface = 1e-9;  // m, above rounding

/// The solid box |x| <= half and a triangle in its frame: a corner or an edge of the triangle in the box, or
/// an edge of the box through the triangle.
bool meets_box(const Corners& triangle, const OrientedBox& box) {
  Corners local;
  for (std::size_t k = 0; k < 3; ++k) local[k] = box.axes.transpose() * (triangle[k] - box.center);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 p = local[k], way = local[(k + 1) % 3] - p;
    double from = 0, to = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (-box.half[axis] - p[axis]) / way[axis], b = (box.half[axis] - p[axis]) / way[axis];
      if (way[axis] != 0)
        from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
      else if (std::abs(p[axis]) > box.half[axis])
        to = -1;
    }
    if (from <= to) return true;
  }
  const std::array<Vec3, 8> corner = corners(box);
  return std::any_of(box_edges.begin(), box_edges.end(), [&](const auto& edge) {
    return intersection_of(corner[at(edge[0])], corner[at(edge[1])], triangle) != Intersection::apart;
  });
}

class BoxShape final : public ObstacleShape {
 public:
  BoxShape() : ObstacleShape({"box", "Box", "A cube or rectangle under the cloth.", BodyKind::box}) {}

  Fields<Obstacle> fields() const override {
    return {field(&Obstacle::center, place_info("center", "Centre", "Centre of the box.")),
            field(&Obstacle::size, positive({.key = "size",
                                             .label = "Size",
                                             .unit = "m",
                                             .doc = "Full lengths of the box along x, y and z.",
                                             .slider_minimum = 0.01,
                                             .slider_maximum = 2}))};
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
  std::optional<SurfacePoint> penetration(const Obstacle& box, const Vec3& point) const override {
    const Vec3 inside = point - box.center;
    const Vec3 depth = 0.5 * box.size - inside.cwiseAbs();
    int axis = 0;
    if (!(depth.minCoeff(&axis) > 0)) return std::nullopt;
    return on_face(box, axis, inside[axis] < 0 ? -1 : 1, point);
  }
  /// Not on the nearest face, which after a long step may be beyond an edge or on the far side, but on the
  /// face that the straight path went through.
  std::optional<SurfacePoint> entry(const Obstacle& box, const Vec3& from, const Vec3& point) const override {
    const auto inside = penetration(box, point);
    if (!inside) return inside;
    int axis = -1;
    double latest = -1;  // part of the way
    for (int k = 0; k < 3; ++k) {
      const double half = 0.5 * box.size[k];
      const double side = from[k] < box.center[k] ? -1 : 1;
      const double before = side * (from[k] - box.center[k]) - half;
      const double after = side * (point[k] - box.center[k]) - half;
      if (!(before >= -on_surface) || !(after < before)) continue;
      const double part = std::max(before, 0.0) / (before - after);
      if (part > latest) latest = part, axis = k;
    }
    return axis < 0 ? inside : on_face(box, axis, from[axis] < box.center[axis] ? -1 : 1, point);
  }
  std::optional<SurfacePoint> along(const Obstacle& box, const Vec3& normal,
                                    const Vec3& point) const override {
    const Vec3 out = 0.5 * box.size.cwiseProduct(normal);
    return SurfacePoint{point - normal.dot(point - box.center - out) * normal, normal};
  }
  void grow(Obstacle& box, double length) const override { box.size += Vec3::Constant(2 * length); }
  bool touches(const Obstacle& box, const Pose& pose, const Corners& triangle) const override {
    return meets_box(triangle,
                     {pose.at(box.center), pose.rotation, (0.5 * box.size).cwiseProduct(pose.stretch)});
  }

 private:
  /// The point on the face at the lower (-1) or upper (1) side along an axis.
  static SurfacePoint on_face(const Obstacle& box, int axis, double side, const Vec3& point) {
    SurfacePoint face{point, Vec3::Zero()};
    face.normal[axis] = side;
    face.point[axis] = box.center[axis] + side * 0.5 * box.size[axis];
    return face;
  }
};

}  // namespace

const ObstacleShape& box_shape() {
  static const BoxShape shape;
  return shape;
}

}  // namespace cloth
