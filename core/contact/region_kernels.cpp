#include "contact/region_kernels.h"

#pragma GCC diagnostic ignored "-Wpsabi"  // every function that takes a vector is inlined

namespace cloth {
namespace {

using Ends [[gnu::vector_size(32)]] = short;

/// One region eight times.
class Same {
 public:
  CLOTHLAB_INLINE explicit Same(const CoarseRegion& region) {
    for (int axis = 0; axis < axes; ++axis) {
      const short low = region.lower[axis], high = static_cast<short>(-region.upper[axis]);
      ends_[axis] =
          Ends{low, low, low, low, low, low, low, low, high, high, high, high, high, high, high, high};
    }
  }

  /// A bit for each of the others that overlaps or touches it along all axes.
  CLOTHLAB_INLINE unsigned overlapping(const EightRegions& others) const {
    Ends outside = beyond(0, others);
    for (int axis = 1; axis < axes; ++axis) outside |= beyond(axis, others);
    return ~bits(outside) & 255U;
  }

 private:
  static constexpr int axes = region_axes;

  CLOTHLAB_INLINE Ends beyond(int axis, const EightRegions& others) const {
    Ends end;
    __builtin_memcpy(&end, __builtin_assume_aligned(others.ends[axis], sizeof end), sizeof end);
    return ends_[axis] > end;
  }

  /// Of those of both ends.
  CLOTHLAB_INLINE static unsigned bits(const Ends& mask) {
#if defined(__AVX2__)
    const auto bytes = __builtin_ia32_packsswb256(mask, mask);
    const auto all = static_cast<unsigned>(__builtin_ia32_pmovmskb256(bytes));
    return all | all >> 16;
#else
    unsigned all = 0;
    for (int k = 0; k < 8; ++k) all |= ((mask[k] | mask[k + 8]) & 1U) << k;
    return all;
#endif
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
