// Where a particle may be in a round of contact, and its extents.
#pragma once

#include <algorithm>

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

/// The extent along a unit axis.
inline Interval along(const Vec3& axis, const Capsule& capsule) {
  const double from = axis.dot(capsule.from), to = axis.dot(capsule.to);
  return {std::min(from, to) - capsule.radius, std::max(from, to) + capsule.radius};
}

}  // namespace cloth
