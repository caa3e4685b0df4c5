#include "contact/seen_boxes.h"

#include <cmath>
#include <numbers>

namespace cloth {
namespace {

/// m, largest distance of an arc from its chord, for a point that rotates at `radius` metres from the axis.
double bulge(const PoseInterpolation& path, double radius) {
  if (path.angle() >= 2 * std::numbers::pi) return 2 * radius;
  return radius * (1 - std::cos(0.5 * path.angle()));
}

/// A bounding box in the coordinates of an obstacle.
Bounds seen_from(const Pose& pose, const Bounds& box) {
  const Vec3 middle = pose.inverse(0.5 * (box.lower + box.upper));
  const Vec3 half = pose.rotation.cwiseAbs().transpose() * (0.5 * (box.upper - box.lower));
  return {middle - half.cwiseQuotient(pose.stretch), middle + half.cwiseQuotient(pose.stretch)};
}

}  // namespace

/// The displacement of the pivot rotates too, and deviates from the chord by t (1 - t) times the angle.
double seen_bulge(const PoseInterpolation& path, double radius) {
  return bulge(path, radius) + 0.25 * path.angle() * (path.pivot(1) - path.pivot(0)).norm();
}

/// A point that rotates and whose distance from the pivot changes deviates from the chord by at most an
/// eighth of the second derivative.
Bounds swept_box(const PoseInterpolation& path, const Vec3& pivot, const Vec3& point, double reach) {
  const double radius = (point - pivot).norm();
  return bounds_of(path.from().at(point), path.to().at(point))
      .grown(reach + bulge(path, path.largest_stretch() * radius) +
             0.25 * path.angle() * path.growth() * radius);
}

void seen_from_body(const ObstacleBody& body, const PoseInterpolation& path, const std::vector<Bounds>& boxes,
                    double reach, std::vector<Bounds>& seen) {
  const Vec3 pivot = path.from().at(body.pivot);
  const bool at_home = path.is_still() && path.from() == Pose{};
  seen.resize(boxes.size());
  for (std::size_t f = 0; f < boxes.size(); ++f) {
    const Bounds& box = boxes[f];
    seen[f] = at_home ? box : seen_from(path.from(), box);
    if (!path.is_still()) seen[f].add(seen_from(path.to(), box));
    const double radius = (0.5 * (box.lower + box.upper) - pivot).norm() + (box.upper - box.lower).norm();
    seen[f] = seen[f].grown((reach + seen_bulge(path, radius)) / path.least_stretch());
  }
}

Capsule seen_at_rest(const PoseInterpolation& path, const Capsule& capsule, double reach) {
  const Pose& pose = path.from();
  return {pose.inverse(capsule.from), pose.inverse(capsule.to),
          (capsule.radius + reach) / path.least_stretch()};
}

}  // namespace cloth
