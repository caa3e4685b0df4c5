#include "contact/region_kernels.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // every function that takes a vector is inlined

namespace cloth {
namespace {

using Half [[gnu::vector_size(16)]] = short;

CLOTHLAB_INLINE Half all(int value) {
  const auto v = static_cast<short>(value);
  return Half{v, v, v, v, v, v, v, v};
}

// Ends of eight regions along an axis, as EightRegions has them; which of two are greater; and a bit for each
// region of which an end is.

#if defined(__AVX2__)
using Ends [[gnu::vector_size(32)]] = short;
using Greater = Ends;

CLOTHLAB_INLINE Ends joined(const Half& first, const Half& second) {
  return __builtin_shufflevector(first, second, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
CLOTHLAB_INLINE Greater greater(const Ends& a, const Ends& b) {
  return a > b;
}
CLOTHLAB_INLINE unsigned bits(const Greater& mask) {
  const auto both = static_cast<unsigned>(__builtin_ia32_pmovmskb256(__builtin_ia32_packsswb256(mask, mask)));
  return (both | both >> 16) & 255U;
}
#else
struct Ends {
  Half first, second;
};
using Greater = Half;

CLOTHLAB_INLINE Ends joined(const Half& first, const Half& second) {
  return {first, second};
}
CLOTHLAB_INLINE Greater greater(const Ends& a, const Ends& b) {
  return (a.first > b.first) | (a.second > b.second);
}
CLOTHLAB_INLINE unsigned bits(const Greater& mask) {
#if defined(__SSE2__)
  return static_cast<unsigned>(__builtin_ia32_pmovmskb128(__builtin_ia32_packsswb128(mask, mask))) & 255U;
#else
  unsigned every = 0;
  for (int k = 0; k < 8; ++k) every |= (mask[k] & 1U) << k;
  return every;
#endif
}
#endif

/// One region eight times.
class Same {
 public:
  CLOTHLAB_INLINE explicit Same(const CoarseRegion& region) {
    for (int axis = 0; axis < axes; ++axis)
      ends_[axis] = joined(all(region.lower[axis]), all(-region.upper[axis]));
  }

  /// A bit for each of the others that overlaps or touches it along all axes.
  CLOTHLAB_INLINE unsigned overlapping(const EightRegions& others) const {
    Greater outside = beyond(0, others);
    for (int axis = 1; axis < axes; ++axis) outside |= beyond(axis, others);
    return ~bits(outside) & 255U;
  }

 private:
  static constexpr int axes = region_axes;

  CLOTHLAB_INLINE Greater beyond(int axis, const EightRegions& others) const {
    Ends end;
    __builtin_memcpy(&end, __builtin_assume_aligned(others.ends[axis], sizeof end), sizeof end);
    return greater(ends_[axis], end);
  }

  Ends ends_[axes];
};

/// take(overlap, hits) for those of the overlaps whose regions may overlap `region`; without branches up to
/// there: a processor cannot predict them.
template <class Take>
CLOTHLAB_INLINE void take_overlapping(const EightRegions* eights, const RegionOverlap* overlaps, int count,
                                      const CoarseRegion& region, const Take& take) {
  const Same same(region);
  constexpr int part = 64;
  RegionOverlap some[part];
  for (int begin = 0; begin < count; begin += part) {
    const int end = begin + part < count ? begin + part : count;
    int found = 0;
    for (int k = begin; k < end; ++k) {
      const unsigned hits = overlaps[k].hits & same.overlapping(eights[overlaps[k].eight]);
      some[found] = overlaps[k], some[found].hits = hits & 255U;
      found += hits != 0 ? 1 : 0;
    }
    for (int k = 0; k < found; ++k) take(some[k]);
  }
}

int narrow(const EightRegions* eights, const RegionOverlap* overlaps, int count, const CoarseRegion& region,
           RegionOverlap* left) {
  int found = 0;
  take_overlapping(eights, overlaps, count, region,
                   [&](const RegionOverlap& overlap) { left[found++] = overlap; });
  return found;
}

int find(const EightRegions* eights, const RegionOverlap* overlaps, int count, const CoarseRegion& region,
         int* places) {
  int found = 0;
  take_overlapping(eights, overlaps, count, region, [&](const RegionOverlap& overlap) {
    const int first = 8 * static_cast<int>(overlap.eight);
    for (unsigned hits = overlap.hits; hits != 0; hits &= hits - 1)
      places[found++] = first + __builtin_ctz(hits);
  });
  return found;
}

constexpr RegionKernels table{narrow, find};

}  // namespace

const RegionKernels& RegionKernels::CLOTHLAB_SET() {
  return table;
}

}  // namespace cloth
