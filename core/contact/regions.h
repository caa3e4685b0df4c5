// Where a particle may be in a round of contact, and its extents.
#pragma once

#include <algorithm>
#include <cstddef>

#include "contact/coarse_regions.h"
#include "geometry/bounds.h"

namespace cloth {

/// All points within `radius` of a segment: bounds a particle in a round.
struct Capsule {
  Vec3 from{0, 0, 0}, to{0, 0, 0};  ///< m
  double radius = 0;                ///< m
};

struct Interval {
  double low = Bounds::infinity, high = -Bounds::infinity;  ///< empty by default

  void add(const Interval& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
};

inline Bounds box_of(const Capsule& capsule) {
  return bounds_of(capsule.from, capsule.to).grown(capsule.radius);
}

/// Bounded by a box and by its extents along the four diagonals of a cube (together a discrete orientation
/// polytope of 14 sides, Klosowski et al. 1998): the box alone of an edge or a face that lies askew is mostly
/// empty. In single precision: rounding keeps the order of numbers, so that regions that overlap do so when
/// rounded.
struct RoundedRegion {
  /// m, along x, y and z, and along x + y + z, x + y - z, x - y + z and -x + y + z.
  float lower[region_axes] = {}, upper[region_axes] = {};

  Bounds box() const { return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}}; }

  bool contains(const RoundedRegion& other) const {
    bool all = true;
    for (std::size_t axis = 0; axis < region_axes; ++axis)
      all &= lower[axis] <= other.lower[axis] && other.upper[axis] <= upper[axis];
    return all;
  }
};

namespace of_regions {

constexpr double diagonal = 1.7320508075688774;  // length of (1, 1, 1)

inline Eigen::Vector4d along_diagonals(const Vec3& p) {
  return {p.x() + p.y() + p.z(), p.x() + p.y() - p.z(), p.x() - p.y() + p.z(), p.y() + p.z() - p.x()};
}

/// `from`, `to` and `beyond`, in m along the diagonals, which are not of length one: of a segment's ends, and
/// by how much further the region extends. The sums of three numbers are rounded.
inline RoundedRegion rounded(const Bounds& box, const Eigen::Vector4d& from, const Eigen::Vector4d& to,
                             double beyond) {
  constexpr double of_rounding = 1e-15;
  const double largest = std::max(from.cwiseAbs().maxCoeff(), to.cwiseAbs().maxCoeff());
  const Eigen::Vector4d all = Eigen::Vector4d::Constant(beyond + of_rounding * largest);
  RoundedRegion region;
  Eigen::Map<Eigen::Vector3f>(region.lower) = box.lower.cast<float>();
  Eigen::Map<Eigen::Vector3f>(region.upper) = box.upper.cast<float>();
  Eigen::Map<Eigen::Vector4f>(region.lower + 3) = (from.cwiseMin(to) - all).cast<float>();
  Eigen::Map<Eigen::Vector4f>(region.upper + 3) = (from.cwiseMax(to) + all).cast<float>();
  return region;
}

}  // namespace of_regions

inline RoundedRegion rounded(const Bounds& box) {
  const Eigen::Vector4d middle = of_regions::along_diagonals(0.5 * (box.lower + box.upper));
  return of_regions::rounded(box, middle, middle, 0.5 * (box.upper - box.lower).sum());
}

inline RoundedRegion rounded(const Capsule& capsule) {
  return of_regions::rounded(box_of(capsule), of_regions::along_diagonals(capsule.from),
                             of_regions::along_diagonals(capsule.to), of_regions::diagonal * capsule.radius);
}

/// Around all points that are no further than `by` metres from the region.
inline RoundedRegion grown(RoundedRegion region, double by) {
  for (std::size_t axis = 0; axis < region_axes; ++axis) {
    const auto more = static_cast<float>(axis < 3 ? by : of_regions::diagonal * by);
    region.lower[axis] -= more, region.upper[axis] += more;
  }
  return region;
}

/// The extent along a unit axis.
inline Interval along(const Vec3& axis, const Capsule& capsule) {
  const double from = axis.dot(capsule.from), to = axis.dot(capsule.to);
  return {std::min(from, to) - capsule.radius, std::max(from, to) + capsule.radius};
}

}  // namespace cloth
