// What sparse/line_interpolation.h hands to kernels: plain numbers.
#pragma once

namespace cloth {

/// Of consecutive points from `first` on.
struct LineWeights {
  static constexpr int most = 6;
  int first = 0, count = 0;
  float weight[most] = {};
};

struct CoarseLine {
  static constexpr int mask_reach = 2, mask_size = 2 * mask_reach + 1;
  int fine = 0, coarse = 0;               ///< points; as many of both: none is left out
  const LineWeights* parents = nullptr;   ///< of each fine point, coarse points
  const LineWeights* children = nullptr;  ///< of each coarse point, fine points
  float mask[mask_size] = {};             ///< away from the ends: of coarse point i in fine point 2 i - 2 + k
  int regular_begin = 0, regular_end = 0;  ///< fine points whose weights are those of the mask
};

}  // namespace cloth
