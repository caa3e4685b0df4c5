#include "contact/region_kernels.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // every function that takes a vector is inlined

namespace cloth {
namespace {

using Eight [[gnu::vector_size(32)]] = float;

CLOTHLAB_INLINE Eight all(float value) {
  return Eight{value, value, value, value, value, value, value, value};
}

#ifdef __AVX__
using Mask = Eight;

CLOTHLAB_INLINE Mask at_most(const Eight& a, const Eight& b) {
  constexpr int less_or_equal = 2;
  return __builtin_ia32_cmpps256(a, b, less_or_equal);
}
CLOTHLAB_INLINE Mask both(const Mask& a, const Mask& b) {
  return __builtin_ia32_andps256(a, b);
}
CLOTHLAB_INLINE unsigned bits(const Mask& mask) {
  return static_cast<unsigned>(__builtin_ia32_movmskps256(mask));
}
#else
using Mask [[gnu::vector_size(32)]] = int;

CLOTHLAB_INLINE Mask at_most(const Eight& a, const Eight& b) {
  return a <= b;
}
CLOTHLAB_INLINE Mask both(const Mask& a, const Mask& b) {
  return a & b;
}
CLOTHLAB_INLINE unsigned bits(const Mask& mask) {
  unsigned all = 0;
#ifdef __SSE2__
  using Half [[gnu::vector_size(16)]] = float;
  Half halves[2];
  __builtin_memcpy(halves, &mask, sizeof mask);
  all = static_cast<unsigned>(__builtin_ia32_movmskps(halves[0]) | __builtin_ia32_movmskps(halves[1]) << 4);
#else
  for (int k = 0; k < 8; ++k) all |= (mask[k] & 1U) << k;
#endif
  return all;
}
#endif

/// One region eight times.
template <int axes>
struct Same {
  Eight lower[axes], upper[axes];

  CLOTHLAB_INLINE explicit Same(const RoundedExtents<axes>& extents) {
    for (int axis = 0; axis < axes; ++axis)
      lower[axis] = all(extents.lower[axis]), upper[axis] = all(extents.upper[axis]);
  }

  CLOTHLAB_INLINE unsigned overlapping(const EightExtents<axes>& others) const {
    Mask hit = along(0, others);
    for (int axis = 1; axis < axes; ++axis) hit = both(hit, along(axis, others));
    return bits(hit);
  }

 private:
  CLOTHLAB_INLINE Mask along(int axis, const EightExtents<axes>& others) const {
    Eight low, high;
    __builtin_memcpy(&low, __builtin_assume_aligned(others.lower[axis], sizeof low), sizeof low);
    __builtin_memcpy(&high, __builtin_assume_aligned(others.upper[axis], sizeof high), sizeof high);
    return both(at_most(low, upper[axis]), at_most(lower[axis], high));
  }
};

/// First which eights have any box that overlaps, without branches: a processor cannot predict them.
int find(const EightRegions* eights, const RegionOverlap* overlaps, int count, const RoundedRegion& region,
         int* places) {
  const Same<3> box(region.box);
  const Same<4> diagonals(region.diagonals);
  constexpr int part = 64;
  int first[part];
  unsigned hits[part];
  int found = 0;
  for (int begin = 0; begin < count; begin += part) {
    const int end = begin + part < count ? begin + part : count;
    int some = 0;
    for (int k = begin; k < end; ++k) {
      const unsigned eight = overlaps[k].eight;
      first[some] = static_cast<int>(eight);
      hits[some] = overlaps[k].hits & box.overlapping(eights[eight].boxes);
      some += hits[some] != 0 ? 1 : 0;
    }
    for (int k = 0; k < some; ++k) {
      unsigned left = hits[k] & diagonals.overlapping(eights[first[k]].diagonals);
      for (; left != 0; left &= left - 1) places[found++] = 8 * first[k] + __builtin_ctz(left);
    }
  }
  return found;
}

constexpr RegionKernels table{find};

}  // namespace

const RegionKernels& RegionKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
