// Extents of regions along some axes in single precision, those of eight regions side by side and tested at
// once. Rounding keeps the order of numbers, so that regions that overlap do so when rounded. Kernels (a
// source for each instruction set) use the data alone and none of these functions.
#pragma once

#include <cstddef>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace cloth {

template <std::size_t axes>
struct RoundedExtents {
  float lower[axes] = {}, upper[axes] = {};  ///< m

  /// To those of both.
  void add(const RoundedExtents& other) {
    for (std::size_t axis = 0; axis < axes; ++axis) {
      lower[axis] = other.lower[axis] < lower[axis] ? other.lower[axis] : lower[axis];
      upper[axis] = upper[axis] < other.upper[axis] ? other.upper[axis] : upper[axis];
    }
  }
};

template <std::size_t axes>
struct alignas(64) EightExtents {
  static constexpr std::size_t count = 8;

  float lower[axes][count] = {}, upper[axes][count] = {};  ///< m

  void set(std::size_t k, const RoundedExtents<axes>& extents) {
    for (std::size_t axis = 0; axis < axes; ++axis)
      lower[axis][k] = extents.lower[axis], upper[axis][k] = extents.upper[axis];
  }

  /// A bit for each whose extents overlap or touch these along all axes.
  std::uint32_t overlapping(const RoundedExtents<axes>& extents) const {
#if defined(__SSE2__)
    __m128 first = _mm_castsi128_ps(_mm_set1_epi32(-1)), second = first;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      const __m128 from = _mm_set1_ps(extents.lower[axis]), to = _mm_set1_ps(extents.upper[axis]);
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
      for (std::size_t axis = 0; axis < axes; ++axis)
        hit &= lower[axis][k] <= extents.upper[axis] && extents.lower[axis] <= upper[axis][k];
      mask |= static_cast<std::uint32_t>(hit) << k;
    }
    return mask;
#endif
  }
};

using RoundedBox = RoundedExtents<3>;
using EightBoxes = EightExtents<3>;

/// Bounded by a box and by its extents along the four diagonals of a cube (together a discrete orientation
/// polytope of 14 sides, Klosowski et al. 1998): the box alone of an edge or a face that lies askew is mostly
/// empty.
struct RoundedRegion {
  RoundedBox box;
  RoundedExtents<4> diagonals;  ///< along x + y + z, x + y - z, x - y + z and -x + y + z

  /// To the region around both.
  void add(const RoundedRegion& other) { box.add(other.box), diagonals.add(other.diagonals); }
};

struct EightRegions {
  EightBoxes boxes;
  EightExtents<4> diagonals;

  void set(std::size_t k, const RoundedRegion& region) {
    boxes.set(k, region.box), diagonals.set(k, region.diagonals);
  }
};

}  // namespace cloth
