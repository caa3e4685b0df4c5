// Limited springs in the order of their lines, for rounds that go from spring to spring (line_rounds.cpp).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limiter/tension_springs.h"

namespace cloth {

struct PlacedSpring {
  std::uint32_t first, second;  ///< particles
  std::uint32_t line, spring;   ///< the line it is in; its number among all springs
  double rest_length, limit;    ///< m
};

/// Springs in the order of their lines. A place is an index into that order.
struct PlacedSprings {
  PlacedSprings(std::span<const TensionSpring> springs, const ClothSystem& system);

  std::vector<PlacedSpring> at;
  std::vector<std::uint32_t> place;          ///< of each spring
  std::vector<std::uint32_t> around, begin;  ///< places of the springs at each particle, from begin on
};

}  // namespace cloth
