#include "picture/picture_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/obstacle_motion.h"
#include "scene/obstacle_shape.h"

namespace cloth {
namespace {

constexpr double air = 1.08;          // kept around what is framed
constexpr double max_distance = 1e6;  // m

/// A unit vector along `v`, or `otherwise` where v has no direction.
Vec3 direction_of(const Vec3& v, const Vec3& otherwise) {
  const double length = v.stableNorm();
  if (!std::isfinite(length) || !(length > 1e-12)) return otherwise;
  return v / length;
}

double slope_of(const PictureCamera& camera) {
  const double degrees =
      std::isfinite(camera.field_of_view) ? std::clamp(camera.field_of_view, 1.0, 150.0) : 34.4;
  return std::tan(degrees * std::numbers::pi / 360);
}

}  // namespace

EyeFrame::EyeFrame(const PictureCamera& camera, int width, int height) {
  eye = camera.eye.allFinite() ? camera.eye : Vec3(0, 0, 0);
  const Vec3 way = camera.target - eye;
  forward = direction_of(way, -Vec3::UnitZ());
  const Vec3 wanted_up = direction_of(camera.up, Vec3::UnitY());
  // Looking straight up or down: any side will do, as long as it is always the same one.
  const Vec3 spare = std::abs(forward.z()) < 0.9 ? Vec3(-Vec3::UnitZ()) : Vec3(Vec3::UnitY());
  const Vec3 side = forward.cross(wanted_up);
  right = direction_of(side.norm() > 1e-6 ? side : Vec3(forward.cross(spare)), Vec3::UnitX());
  up = right.cross(forward);
  focal_length = 0.5 * height / slope_of(camera);
  middle_x = 0.5 * width;
  middle_y = 0.5 * height;
  near = way.allFinite() ? std::max(1e-6, 0.005 * way.stableNorm()) : 1e-3;
}

Vec3 EyeFrame::to_eye(const Vec3& point) const {
  const Vec3 d = point - eye;
  return {d.dot(right), d.dot(up), d.dot(forward)};
}

Eigen::Vector2d EyeFrame::to_pixel(const Vec3& in_eye) const {
  const double scale = focal_length / in_eye.z();
  return {middle_x + scale * in_eye.x(), middle_y - scale * in_eye.y()};
}

Vec3 EyeFrame::ray(double x, double y) const {
  return forward + (x - middle_x) / focal_length * right + (middle_y - y) / focal_length * up;
}

PictureCamera camera_showing(const Scene& scene, const Vec3Field& position, const Vec3& direction,
                             double aspect, std::span<const PictureArrow> arrows, double time) {
  PictureCamera camera;
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < position.size(); ++i)
    if (position[i].allFinite() && position[i].norm() < max_distance) points.push_back(position[i]);
  for (const PictureArrow& arrow : arrows)
    for (const Vec3& end : {arrow.from, arrow.to})
      if (end.allFinite() && end.norm() < max_distance) points.push_back(end);
  for (const Obstacle& obstacle : scene.obstacles) {
    const Eigen::AlignedBox3d box = shape_of(obstacle).bounds_at(obstacle, pose_of(obstacle, time));
    if (box.isEmpty() || !box.min().allFinite() || !box.max().allFinite()) continue;
    for (int corner = 0; corner < 8; ++corner)
      points.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  }
  const Vec3 towards_eye = direction_of(direction, usual_direction.normalized());
  if (points.empty()) return camera;

  // The middle of what is seen, as wide and high as it looks from far; then the least distance that shows it
  // all.
  camera.target = points.front();
  camera.eye = camera.target + towards_eye;
  const EyeFrame frame(camera, 2, 2);
  Eigen::AlignedBox3d seen;
  for (const Vec3& p : points) seen.extend(frame.to_eye(p));
  const Vec3 middle = seen.center();
  camera.target = frame.eye + middle.x() * frame.right + middle.y() * frame.up + middle.z() * frame.forward;
  const double slope_y = slope_of(camera),
               slope_x = slope_y * (aspect > 0 && std::isfinite(aspect) ? aspect : 1);
  double distance = 0.05;
  for (const Vec3& p : points) {
    const Vec3 d = air * (frame.to_eye(p) - middle);
    distance = std::max({distance, std::abs(d.x()) / slope_x - d.z(), std::abs(d.y()) / slope_y - d.z()});
  }
  camera.eye = camera.target + distance * towards_eye;
  return camera;
}

}  // namespace cloth
