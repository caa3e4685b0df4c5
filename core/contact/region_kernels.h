// Which of many regions may overlap one: those of a mesh's or the cloth's features, eight by eight in the
// order of their hierarchy of boxes (BoxTree).
#pragma once

#include <cstdint>

#include "contact/coarse_regions.h"
#include "kernels/kernel_table.h"

namespace cloth {

/// A feature, and a bit for each of the places 8 `eight` to 8 `eight` + 7 of an order, of those that exist,
/// that it may overlap.
struct RegionOverlap {
  static constexpr int most_bits = 24;

  int query;
  std::uint32_t eight : most_bits, hits : 8;
};

struct RegionKernels {
  /// Writes those of the overlaps whose regions may overlap `region`, with the bits of those, and returns how
  /// many there are: `left` has room for all, and may not be `overlaps`.
  int (*narrow)(const EightRegions* eights, const RegionOverlap* overlaps, int count,
                const CoarseRegion& region, RegionOverlap* left);

  /// Writes the places of these overlaps whose regions may overlap `region`, one after the other, and returns
  /// how many there are: `places` has room for eight for each overlap. Asked of one query at a time.
  int (*find)(const EightRegions* eights, const RegionOverlap* overlaps, int count,
              const CoarseRegion& region, int* places);

  CLOTHLAB_KERNEL_TABLE(RegionKernels)
};

}  // namespace cloth
