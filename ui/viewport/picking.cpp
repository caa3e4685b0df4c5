#include "viewport/picking.h"

#include <algorithm>
#include <array>
#include <limits>

namespace clothlab {
namespace {

template <class Visit>  // visit(triangle)
void for_each_triangle(const ClothFrame& frame, Visit visit) {
  if (frame.mesh) {
    for (const cloth::Triangle& triangle : frame.mesh->surface.triangles) visit(triangle);
    return;
  }
  for (int r = 0; r + 1 < frame.rows; ++r) {
    for (int c = 0; c + 1 < frame.columns; ++c) {
      const int a = r * frame.columns + c, d = a + frame.columns;
      visit(cloth::Triangle{a, d, d + 1});
      visit(cloth::Triangle{a, d + 1, a + 1});
    }
  }
}

std::optional<int> nearest_hit(const ClothFrame& frame, const Ray& ray) {
  double first = std::numeric_limits<double>::infinity();
  std::optional<int> picked;
  for_each_triangle(frame, [&](const cloth::Triangle& triangle) {
    const std::array corners{particle_position(frame, triangle[0]), particle_position(frame, triangle[1]),
                             particle_position(frame, triangle[2])};
    const double along = distance_to_triangle(ray, corners[0], corners[1], corners[2]);
    if (!(along > 0 && along < first)) return;
    first = along;
    const Eigen::Vector3d hit = ray.origin + along * ray.direction;
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < 3; ++k)
      if ((corners[k] - hit).squaredNorm() < (corners[nearest] - hit).squaredNorm()) nearest = k;
    picked = triangle[nearest];
  });
  return picked;
}

}  // namespace

double distance_to_triangle(const Ray& ray, const Eigen::Vector3d& p, const Eigen::Vector3d& q,
                            const Eigen::Vector3d& r) {
  const Eigen::Vector3d e = q - p, f = r - p, h = ray.direction.cross(f);
  const double det = e.dot(h);
  if (det == 0) return -1;
  const Eigen::Vector3d s = ray.origin - p, k = s.cross(e);
  const double u = s.dot(h) / det, v = ray.direction.dot(k) / det;
  if (!(u >= 0 && v >= 0 && u + v <= 1)) return -1;
  return f.dot(k) / det;
}

Eigen::Vector3d particle_position(const ClothFrame& frame, int particle) {
  const float* p = frame.positions.data() + 3 * static_cast<std::size_t>(particle);
  return {p[0], p[1], p[2]};
}

std::optional<int> pick_particle(const ClothFrame& frame, const Camera& camera,
                                 const Eigen::Vector2d& cursor) {
  if (const std::optional<int> hit = nearest_hit(frame, camera.ray(cursor))) return hit;

  const Eigen::Matrix4d to_screen = camera.world_to_screen();
  double least = picking_tolerance;
  std::optional<int> picked;
  for (int i = 0; i < frame.rows * frame.columns; ++i) {
    const Eigen::Vector4d h = to_screen * particle_position(frame, i).homogeneous();
    if (!(h.w() > 0)) continue;  // behind the eye
    const double distance = (h.head<2>() / h.w() - cursor).norm();
    if (distance < least) least = distance, picked = i;
  }
  return picked;
}

double share_in_picture(const ClothFrame& frame, const Camera& camera, const Eigen::Vector2d& size) {
  constexpr std::size_t enough = 1000;  // particles
  const std::size_t count = frame.positions.size() / 3, stride = std::max<std::size_t>(count / enough, 1);
  const Eigen::Matrix4d to_screen = camera.world_to_screen();
  int asked = 0, inside = 0;
  for (std::size_t i = 0; i < count; i += stride, ++asked) {
    const Eigen::Vector4d seen = to_screen * particle_position(frame, static_cast<int>(i)).homogeneous();
    const Eigen::Vector2d at = seen.head<2>() / seen.w();
    if (seen.w() > 0 && (at.array() >= 0).all() && (at.array() <= size.array()).all()) ++inside;
  }
  return asked > 0 ? static_cast<double>(inside) / asked : 0;
}

}  // namespace clothlab
