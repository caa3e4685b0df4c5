// Random choices that are the same on every machine.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/split_mix.h"

namespace cloth {

/// In [0, 1): the upper 53 bits.
inline double unit_number(std::uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

/// 0, 1, ..., count - 1, each equally likely. Precondition: count > 0.
inline std::size_t choice_below(SplitMix& random, std::size_t count) {
  const std::uint64_t n = count, unfair = (0 - n) % n;  // the lowest 2^64 mod n values would count twice
  std::uint64_t bits = random.bits();
  while (bits < unfair) bits = random.bits();
  return static_cast<std::size_t>(bits % n);
}

/// 0, 1, ..., count - 1 in a random order (Fisher and Yates 1938).
inline std::vector<std::size_t> random_order(SplitMix& random, std::size_t count) {
  std::vector<std::size_t> order(count);
  for (std::size_t k = 0; k < count; ++k) order[k] = k;
  for (std::size_t k = count; k > 1; --k) std::swap(order[k - 1], order[choice_below(random, k)]);
  return order;
}

}  // namespace cloth
