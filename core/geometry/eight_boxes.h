// Boxes in single precision, eight side by side and tested at once. Rounding keeps the order of numbers, so
// that boxes that overlap do so when rounded.
#pragma once

#include <cstddef>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace cloth {

struct RoundedBox {
  float lower[3], upper[3];  ///< m
};

struct alignas(64) EightBoxes {
  static constexpr std::size_t count = 8;

  float lower[3][count] = {}, upper[3][count] = {};  ///< m

  void set(std::size_t k, const RoundedBox& box) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      lower[axis][k] = box.lower[axis], upper[axis][k] = box.upper[axis];
  }

  /// A bit for each that overlaps or touches `box`.
  std::uint32_t overlapping(const RoundedBox& box) const {
#if defined(__SSE2__)
    __m128 first = _mm_castsi128_ps(_mm_set1_epi32(-1)), second = first;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const __m128 from = _mm_set1_ps(box.lower[axis]), to = _mm_set1_ps(box.upper[axis]);
      const float *low = lower[axis], *high = upper[axis];
      first = _mm_and_ps(
          first, _mm_and_ps(_mm_cmple_ps(_mm_load_ps(low), to), _mm_cmple_ps(from, _mm_load_ps(high))));
      second = _mm_and_ps(second, _mm_and_ps(_mm_cmple_ps(_mm_load_ps(low + 4), to),
                                             _mm_cmple_ps(from, _mm_load_ps(high + 4))));
    }
    return static_cast<std::uint32_t>(_mm_movemask_ps(first) | _mm_movemask_ps(second) << 4);
#else
    std::uint32_t mask = 0;
    for (std::size_t k = 0; k < count; ++k) {
      bool hit = true;
      for (std::size_t axis = 0; axis < 3; ++axis)
        hit &= lower[axis][k] <= box.upper[axis] && box.lower[axis] <= upper[axis][k];
      mask |= static_cast<std::uint32_t>(hit) << k;
    }
    return mask;
#endif
  }
};

}  // namespace cloth
