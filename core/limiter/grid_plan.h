// The limited springs of a grid grouped by direction, in arrays with padding on every side, so
// that loops over springs need no boundary cases.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "limiter/tension_springs.h"

namespace cloth {

struct GridFamily {
  int down = 0, across = 0;           ///< rows and columns from a spring's first end to its second
  int rows = 0;                       ///< in which springs begin, from row 0 on
  int begin = 0, end = 0;             ///< columns in which they begin
  std::size_t first_spring = 0;       ///< in the order of the springs, row by row
  double rest_length = 0, limit = 0;  ///< m
  int width() const { return end - begin; }
};

struct GridPlan {
  int rows = 0, columns = 0;
  int padding = 0;  ///< rows and columns of padding on every side
  int stride = 0;   ///< array elements per row, padding included
  std::vector<GridFamily> families;

  std::ptrdiff_t index(int row, int column) const {
    return static_cast<std::ptrdiff_t>(row + padding) * stride + column + padding;
  }
  std::size_t size() const {
    return static_cast<std::size_t>(rows + 2 * padding) * static_cast<std::size_t>(stride);
  }
  std::ptrdiff_t offset(const GridFamily& family) const {
    return static_cast<std::ptrdiff_t>(family.down) * stride + family.across;
  }
};

/// Empty unless the springs contain every spring of each of their directions, on a grid of at least five rows
/// and columns.
std::optional<GridPlan> plan_grid(const std::vector<TensionSpring>& springs, const ClothSystem& system);

}  // namespace cloth
