#include "viewport/obstacle_handle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/obstacle_shape.h"
#include "viewport/picking.h"

namespace clothlab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double distance_to_sphere(const Ray& ray, const Eigen::Vector3d& center, double radius) {
  const Eigen::Vector3d to = center - ray.origin;
  const double along = to.dot(ray.direction),
               under = radius * radius - (to - along * ray.direction).squaredNorm();
  return under >= 0 && along > 0 ? along - std::sqrt(under) : infinity;
}

/// The solid |x| <= half about the origin, by slabs (Kay and Kajiya 1986).
double distance_to_box(const Ray& ray, const Eigen::Vector3d& half) {
  double from = 0, to = infinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (-half[axis] - ray.origin[axis]) / ray.direction[axis],
                 b = (half[axis] - ray.origin[axis]) / ray.direction[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to ? from : infinity;
}

double distance_to_mesh(const Ray& ray, const cloth::TriangleMesh& mesh) {
  double first = infinity;
  for (const cloth::Triangle& t : mesh.triangles) {
    const auto vertex = [&](int k) {
      return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
    };
    const double along = distance_to_triangle(ray, vertex(0), vertex(1), vertex(2));
    if (along > 0) first = std::min(first, along);
  }
  return first;
}

/// m along the ray; planes are everywhere and are not hit.
double distance_to_obstacle(const cloth::Obstacle& o, const cloth::Pose& pose, const Ray& ray) {
  const Eigen::Vector3d pivot = cloth::pivot_of(o);
  const cloth::Pose placed = cloth::about(pivot, pose.rotation, pose.at(pivot));  // as large as it is to be
  const Ray local{placed.inverse(ray.origin), placed.rotation.transpose() * ray.direction};
  switch (shape_of(o).body) {
    case cloth::BodyKind::ball:
      return distance_to_sphere(local, o.center, o.radius);
    case cloth::BodyKind::box:
      return distance_to_box({local.origin - o.center, local.direction}, 0.5 * o.size);
    case cloth::BodyKind::surface: {
      const cloth::PlacedSurface surface = shape_of(o).surface(o);
      if (!surface.mesh || !(surface.scale.minCoeff() > 0)) return infinity;
      const Eigen::AlignedBox3d box = shape_of(o).bounds(o);
      if (distance_to_box({local.origin - box.center(), local.direction}, 0.5 * box.sizes()) == infinity)
        return infinity;
      const cloth::Pose put{surface.rotation, surface.place, surface.scale};
      // Along the unscaled way, so that it is a length in the world whatever the scale of each axis.
      const Eigen::Vector3d along =
          (surface.rotation.transpose() * local.direction).cwiseQuotient(surface.scale);
      const double length = along.norm();
      return distance_to_mesh({put.inverse(local.origin), along / length}, *surface.mesh) / length;
    }
    case cloth::BodyKind::half_space:
      break;
  }
  return infinity;
}

double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d way = b - a;
  const double squared = way.squaredNorm();
  const double part = squared > 0 ? std::clamp((p - a).dot(way) / squared, 0.0, 1.0) : 0;
  return (a + part * way - p).norm();
}

}  // namespace

cloth::Obstacle moved_by(const cloth::Obstacle& obstacle, const Eigen::Vector3d& by) {
  cloth::Obstacle moved = obstacle;
  if (!moved.keyframes.empty()) {
    for (cloth::Keyframe& key : moved.keyframes) key.position += by;
    return moved;
  }
  shape_of(moved).place(moved) += by;
  return moved;
}

bool has_motion(const cloth::Obstacle& obstacle) {
  if (obstacle.keyframes.empty()) return cloth::moves(obstacle);
  const cloth::Keyframe& first = obstacle.keyframes.front();
  return std::any_of(obstacle.keyframes.begin(), obstacle.keyframes.end(), [&](const cloth::Keyframe& key) {
    return key.position != first.position || key.rotation != first.rotation;
  });
}

std::array<Eigen::Vector3d, 3> ObstacleHandle::tips(const Camera& camera) const {
  const Eigen::Vector2d here = camera.project(place);
  const double pixel = (camera.on_screen_plane(here + Eigen::Vector2d(1, 0), place) - place).norm();  // m
  std::array<Eigen::Vector3d, 3> tips;
  for (int axis = 0; axis < 3; ++axis)
    tips[static_cast<std::size_t>(axis)] = place + arrow_length * pixel * Eigen::Vector3d::Unit(axis);
  return tips;
}

ObstacleHandle::Part ObstacleHandle::part_at(const Camera& camera, const Eigen::Vector2d& cursor) const {
  constexpr double tolerance = 3, arrow_tolerance = 7;  // px
  const Eigen::Vector2d here = camera.project(place);
  if ((cursor - here).norm() <= ring_radius + tolerance) return Part::ring;
  const auto ends = tips(camera);
  constexpr std::array parts{Part::x, Part::y, Part::z};
  double least = arrow_tolerance;
  Part found = Part::none;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (const double distance = distance_to_segment(cursor, here, camera.project(ends[axis]));
        distance < least)
      least = distance, found = parts[axis];
  return found;
}

std::optional<ObstacleHandle> handle_at(const ClothFrame& frame, const Camera& camera,
                                        const Eigen::Vector2d& cursor) {
  const Ray ray = camera.ray(cursor);
  std::optional<ObstacleHandle> nearest, hit;
  double least = ObstacleHandle::nearness, first = infinity;
  for (std::size_t k = 0; k < frame.obstacles.size(); ++k) {
    const cloth::Obstacle& o = frame.obstacles[k];
    const Eigen::Vector3d place = frame.target(k).at(cloth::pivot_of(o));
    if ((place - ray.origin).dot(camera.forward()) <= 0) continue;  // behind the eye
    const ObstacleHandle handle{static_cast<int>(k), place};
    if (const double distance = (camera.project(place) - cursor).norm(); distance < least)
      least = distance, nearest = handle;
    if (const double along = distance_to_obstacle(o, frame.pose(k), ray); along < first)
      first = along, hit = handle;
  }
  return nearest ? nearest : hit;
}

Eigen::Vector3d dragged_by(const ObstacleHandle& handle, ObstacleHandle::Part part, const Camera& camera,
                           const Eigen::Vector2d& start, const Eigen::Vector2d& now) {
  using Part = ObstacleHandle::Part;
  if (part == Part::none) return Eigen::Vector3d::Zero();
  if (part == Part::ring)
    return camera.on_screen_plane(now, handle.place) - camera.on_screen_plane(start, handle.place);
  const Eigen::Vector3d axis = Eigen::Vector3d::Unit(part == Part::x ? 0 : part == Part::y ? 1 : 2);
  // The point of the axis that is nearest to the line of sight; one along the axis gives none.
  const auto along = [&](const Eigen::Vector2d& cursor) {
    const Ray ray = camera.ray(cursor);
    const double cosine = axis.dot(ray.direction), sine_squared = 1 - cosine * cosine;
    const Eigen::Vector3d from = handle.place - ray.origin;
    constexpr double least_sine_squared = 1e-3;
    return sine_squared < least_sine_squared
               ? 0
               : (cosine * from.dot(ray.direction) - from.dot(axis)) / sine_squared;
  };
  return (along(now) - along(start)) * axis;
}

}  // namespace clothlab
