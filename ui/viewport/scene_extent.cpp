#include "viewport/scene_extent.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/obstacle_shape.h"
#include "viewport/picking.h"

namespace clothlab {
namespace {

void extend_by(const cloth::Obstacle& o, const cloth::Pose& pose, Eigen::AlignedBox3d& box) {
  box.extend(shape_of(o).bounds_at(o, pose));
}

}  // namespace

Eigen::AlignedBox3d bounds_of_cloth(const ClothFrame& frame) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; 3 * i < frame.positions.size(); ++i) {
    const Eigen::Vector3d p = particle_position(frame, static_cast<int>(i));
    if (p.allFinite()) box.extend(p);  // a run that has diverged must not take the camera with it
  }
  return box;
}

Eigen::AlignedBox3d bounds_of_obstacles(const ClothFrame& frame) {
  Eigen::AlignedBox3d box;
  for (std::size_t k = 0; k < frame.obstacles.size(); ++k) extend_by(frame.obstacles[k], frame.pose(k), box);
  return box;
}

Eigen::AlignedBox3d reach_of_obstacles(const std::vector<cloth::Obstacle>& obstacles) {
  Eigen::AlignedBox3d box;
  for (const cloth::Obstacle& o : obstacles) {
    extend_by(o, cloth::pose_of(o, 0), box);
    for (const cloth::Keyframe& key : o.keyframes) extend_by(o, cloth::pose_of(o, key.time), box);
  }
  return box;
}

Eigen::AlignedBox3d reach_of_cloth(const ClothFrame& frame) {
  Eigen::AlignedBox3d box = bounds_of_cloth(frame);
  std::vector<Eigen::Vector3d> pins;
  for (std::size_t i = 0; i < frame.pinned.size(); ++i)
    if (frame.pinned[i]) pins.push_back(particle_position(frame, static_cast<int>(i)));
  if (pins.empty() || box.isEmpty()) return box;

  // A bound is enough: at most some 64 x 64 particles and 64 pins are looked at.
  const std::size_t count = frame.positions.size() / 3;
  const std::size_t stride = std::max<std::size_t>(count / 4096, 1);
  const std::size_t pin_stride = std::max<std::size_t>(pins.size() / 64, 1);
  double lowest = box.min().y();
  for (std::size_t i = 0; i < count; i += stride) {
    const Eigen::Vector3d p = particle_position(frame, static_cast<int>(i));
    double nearest = std::numeric_limits<double>::infinity(), from = p.y();
    for (std::size_t k = 0; k < pins.size(); k += pin_stride) {
      const double distance = (pins[k] - p).norm();
      if (distance < nearest) nearest = distance, from = pins[k].y();
    }
    if (std::isfinite(nearest)) lowest = std::min(lowest, from - nearest);
  }
  box.extend(Eigen::Vector3d(box.center().x(), lowest, box.center().z()));
  return box;
}

bool is_level(const cloth::Obstacle& obstacle) {
  if (shape_of(obstacle).body != cloth::BodyKind::half_space) return false;
  return std::abs(obstacle.normal.normalized().y()) > 0.999;
}

Ground ground_below(const Eigen::AlignedBox3d& reach, const std::vector<cloth::Obstacle>& obstacles) {
  Ground ground;
  for (const cloth::Obstacle& o : obstacles) {
    if (!is_level(o) || (ground.is_obstacle && o.point.y() <= ground.height)) continue;
    ground = {o.point.y(), true};
  }
  if (ground.is_obstacle) return ground;
  Eigen::AlignedBox3d all = reach;
  all.extend(reach_of_obstacles(obstacles));
  if (all.isEmpty()) return ground;
  ground.height = all.min().y() - 0.06 * all.diagonal().norm();
  return ground;
}

}  // namespace clothlab
