// Bounding boxes in single precision: a quick test that two boxes do not overlap.
#pragma once

#include <algorithm>
#include <array>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "geometry/bounds.h"

namespace cloth {

/// Lower ends and negative upper ends: two boxes overlap where the lower ends of each are at most the upper
/// ends of the other. Rounding keeps the order of numbers, so that boxes that overlap do so when rounded.
struct alignas(32) RoundedBox {
  std::array<float, 8> ends{};  ///< m: lower x, y, z, 0, -upper x, -y, -z, 0

  RoundedBox() = default;
  explicit RoundedBox(const Bounds& box) : ends(in_order(box.lower, -box.upper)) {}

  static std::array<float, 8> in_order(const Vec3& first, const Vec3& second) {
    const Eigen::Vector3f a = first.cast<float>(), b = second.cast<float>();
    return {a.x(), a.y(), a.z(), 0, b.x(), b.y(), b.z(), 0};
  }
};

/// The box around both.
inline RoundedBox joined(const RoundedBox& a, const RoundedBox& b) {
  RoundedBox both;
  for (std::size_t k = 0; k < both.ends.size(); ++k) both.ends[k] = std::min(a.ends[k], b.ends[k]);
  return both;
}

/// What the ends of a RoundedBox must not exceed for it to overlap `box`.
struct alignas(32) RoundedLimits {
  std::array<float, 8> most{};

  explicit RoundedLimits(const RoundedBox& box) {
    for (std::size_t k = 0; k < most.size(); ++k) most[k] = -box.ends[(k + 4) % 8];
  }

  bool may_overlap(const RoundedBox& box) const {
#if defined(__SSE2__)
    const __m128 low = _mm_cmple_ps(_mm_load_ps(box.ends.data()), _mm_load_ps(most.data()));
    const __m128 high = _mm_cmple_ps(_mm_load_ps(box.ends.data() + 4), _mm_load_ps(most.data() + 4));
    return _mm_movemask_ps(_mm_and_ps(low, high)) == 15;
#else
    bool all = true;
    for (std::size_t k = 0; k < most.size(); ++k) all = all & (box.ends[k] <= most[k]);
    return all;
#endif
  }
};

}  // namespace cloth
