// Regions whose ends are whole numbers of 16 bits, those of eight side by side. The numbers keep the order of
// what they stand for, so that regions that overlap do so in these numbers. Kernels (a source for each
// instruction set) use the data alone and none of these functions.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cloth {

inline constexpr std::size_t region_axes = 7;

struct CoarseRegion {
  /// Of one number more than there are axes, which is 0: for registers.
  std::int16_t lower[region_axes + 1] = {}, upper[region_axes + 1] = {};

  /// To the region around both.
  void add(const CoarseRegion& other) {
    for (std::size_t axis = 0; axis <= region_axes; ++axis) {
      lower[axis] = other.lower[axis] < lower[axis] ? other.lower[axis] : lower[axis];
      upper[axis] = upper[axis] < other.upper[axis] ? other.upper[axis] : upper[axis];
    }
  }
};

struct alignas(32) EightRegions {
  static constexpr std::size_t count = 8;

  /// Along each axis the upper ends, then the lower ones negated.
  std::int16_t ends[region_axes][2 * count] = {};

  void set(std::size_t k, const CoarseRegion& region) {
    for (std::size_t axis = 0; axis < region_axes; ++axis) {
      ends[axis][k] = region.upper[axis];
      ends[axis][count + k] = static_cast<std::int16_t>(-region.lower[axis]);
    }
  }
};

}  // namespace cloth
