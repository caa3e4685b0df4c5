// Axis-aligned bounding boxes.
#pragma once

#include <limits>

#include "geometry/vec3_field.h"

namespace cloth {

/// Empty by default: lower above upper, overlapping no finite box.
struct Bounds {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 lower{infinity, infinity, infinity};     ///< m
  Vec3 upper{-infinity, -infinity, -infinity};  ///< m

  // Inlined always: search for contact spends its time here, and compilers count Eigen's expressions as long.
  [[gnu::always_inline]] void add(const Vec3& point) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  [[gnu::always_inline]] void add(const Bounds& other) {
    lower = lower.cwiseMin(other.lower);
    upper = upper.cwiseMax(other.upper);
  }
  Bounds grown(double margin) const {
    const Vec3 all = Vec3::Constant(margin);
    return {lower - all, upper + all};
  }
};

template <class... Points>
Bounds bounds_of(const Points&... points) {
  Bounds bounds;
  (bounds.add(points), ...);
  return bounds;
}

inline Bounds joined(const Bounds& a, const Bounds& b) {
  return bounds_of(a, b);
}

/// Boxes that touch overlap.
inline bool overlap(const Bounds& a, const Bounds& b) {
  bool all = true;
  for (int axis = 0; axis < 3; ++axis)  // without branches: the separating axis is unpredictable
    all = all & (a.lower[axis] <= b.upper[axis]) & (b.lower[axis] <= a.upper[axis]);
  return all;
}

/// The sides of `box` beyond which `part` lies wholly (Cohen and Sutherland's codes, Newman and Sproull
/// 1979): bit 2 k below along axis k, bit 2 k + 1 above. The common box of several parts overlaps or touches
/// `box` where no bit is set in the codes of all of them.
inline unsigned outcode(const Bounds& part, const Bounds& box) {
  unsigned code = 0;
  for (int axis = 0; axis < 3; ++axis)
    code |= (part.upper[axis] < box.lower[axis] ? 1U : 0U) << (2 * axis) |
            (part.lower[axis] > box.upper[axis] ? 2U : 0U) << (2 * axis);
  return code;
}

}  // namespace cloth
