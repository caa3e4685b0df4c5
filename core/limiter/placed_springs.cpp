#include "limiter/placed_springs.h"

#include <cstddef>

namespace cloth {

PlacedSprings::PlacedSprings(std::span<const TensionSpring> springs, const ClothSystem& system) {
  const SpringLines lines = spring_lines(springs, system);
  const auto small = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
  place.resize(springs.size());
  at.reserve(springs.size());
  for (std::size_t line = 0; line < lines.count(); ++line)
    for (std::size_t k = lines.begin[line]; k < lines.begin[line + 1]; ++k) {
      const std::size_t s = lines.springs[k];
      const TensionSpring& spring = springs[s];
      place[s] = small(at.size());
      at.push_back({small(spring.first), small(spring.second), small(line), small(s), spring.rest_length,
                    spring.limit});
    }
  begin.assign(static_cast<std::size_t>(system.size()) + 2, 0);
  for (const TensionSpring& spring : springs)
    for (const std::size_t end : {spring.first, spring.second}) ++begin[end + 2];
  for (std::size_t i = 2; i < begin.size(); ++i) begin[i] += begin[i - 1];
  around.resize(2 * springs.size());
  for (std::size_t s = 0; s < springs.size(); ++s)
    for (const std::size_t end : {springs[s].first, springs[s].second}) around[begin[end + 1]++] = place[s];
}

}  // namespace cloth
