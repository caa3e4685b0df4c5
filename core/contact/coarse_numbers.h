// From regions in metres to coarse ones.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "contact/coarse_regions.h"
#include "contact/regions.h"

namespace cloth {

/// The numbers: 4096 to a unit near some middle, and less with the distance from it like those of single
/// precision, up to 255 units, beyond which they are the same.
class CoarseNumbers {
 public:
  CoarseNumbers() = default;
  /// `unit`: m, greater than 0.
  CoarseNumbers(const Vec3& middle, double unit) : units_(static_cast<float>(1 / unit)) {
    const auto of_middle = rounded(Capsule{middle, middle});
    for (std::size_t axis = 0; axis < region_axes; ++axis) middle_[axis] = of_middle.lower[axis];
  }

  bool operator==(const CoarseNumbers&) const = default;

  CoarseRegion of(const RoundedRegion& region) const {
    CoarseRegion coarse;
    for (std::size_t axis = 0; axis < region_axes; ++axis) {
      coarse.lower[axis] = of(region.lower[axis] - middle_[axis]);
      coarse.upper[axis] = of(region.upper[axis] - middle_[axis]);
    }
    return coarse;
  }

  /// Around all that the numbers may stand for, and more by two of them.
  Bounds box(const CoarseRegion& region) const {
    Bounds box;
    for (int axis = 0; axis < 3; ++axis) {
      box.lower[axis] = metres(region.lower[axis] - 2, axis);
      box.upper[axis] = metres(region.upper[axis] + 2, axis);
    }
    return box;
  }

 private:
  static constexpr int shift = 11, most = 32767;

  /// The numbers of single precision from one on are in the order of their bits.
  std::int16_t of(float from_middle) const {
    const float units = from_middle * units_;
    const float above_one = 1 + (units < 0 ? -units : units);
    const std::int32_t steps =
        (std::bit_cast<std::int32_t>(above_one) - std::bit_cast<std::int32_t>(1.0f)) >> shift;
    const std::int32_t held = steps < most ? steps : most;
    return static_cast<std::int16_t>(units < 0 ? -held : held);
  }

  double metres(int number, int axis) const {
    const double sign = number < 0 ? -1 : 1;
    if (std::abs(number) >= most) return sign * Bounds::infinity;
    const auto above_one =
        std::bit_cast<float>(std::bit_cast<std::int32_t>(1.0f) + (std::abs(number) << shift));
    return middle_[static_cast<std::size_t>(axis)] + sign * (double{above_one} - 1) / units_;
  }

  std::array<float, region_axes> middle_{};
  float units_ = 1;  ///< in a metre
};

}  // namespace cloth
