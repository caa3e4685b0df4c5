#include "limiter/grid_plan.h"

#include <algorithm>
#include <cstdlib>

namespace cloth {
namespace {

constexpr int fewest_lines = 5;  ///< with fewer, offsets of different directions could be the same
constexpr int furthest = 2;

/// The family that would begin with this spring.
GridFamily family_from(const TensionSpring& spring, const ClothSystem& system) {
  const auto columns = static_cast<std::size_t>(system.columns);
  GridFamily family;
  family.down = static_cast<int>(spring.second / columns) - static_cast<int>(spring.first / columns);
  family.across = static_cast<int>(spring.second % columns) - static_cast<int>(spring.first % columns);
  family.rows = system.rows - family.down;
  family.begin = std::max(0, -family.across);
  family.end = system.columns - std::max(0, family.across);
  family.rest_length = spring.rest_length;
  family.limit = spring.limit;
  return family;
}

}  // namespace

std::optional<GridPlan> plan_grid(const std::vector<TensionSpring>& springs, const ClothSystem& system) {
  if (system.is_mesh() || system.rows < fewest_lines || system.columns < fewest_lines) return std::nullopt;
  GridPlan plan;
  plan.rows = system.rows, plan.columns = system.columns;
  for (std::size_t s = 0; s < springs.size();) {
    GridFamily family = family_from(springs[s], system);
    family.first_spring = s;
    const int far = std::max(std::abs(family.down), std::abs(family.across));
    if (far > furthest || family.down < 0 || (family.down == 0 && family.across <= 0)) return std::nullopt;
    plan.padding = std::max(plan.padding, far);
    for (int row = 0; row < family.rows; ++row)
      for (int column = family.begin; column < family.end; ++column, ++s) {
        const TensionSpring expected{
            static_cast<std::size_t>(system.index(row, column)),
            static_cast<std::size_t>(system.index(row + family.down, column + family.across)),
            family.rest_length, family.limit};
        if (s >= springs.size() || springs[s] != expected) return std::nullopt;
      }
    plan.families.push_back(family);
  }
  plan.stride = plan.columns + 2 * plan.padding;
  return plan;
}

}  // namespace cloth
