// The layout in which the deformation limiter's tension solver (grid_rounds.h) stores the limited springs of
// a grid: by direction, in row-major arrays with padding on every side, so that loops over springs need no
// boundary cases.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "limiter/tension_springs.h"

namespace cloth {

/// All limited springs of one direction.
struct GridFamily {
  int down = 0, across = 0;           ///< rows and columns from a spring's first particle to its second
  int rows = 0;                       ///< springs begin in the rows 0 to rows - 1
  int begin = 0, end = 0;             ///< springs begin in the columns begin to end - 1
  std::size_t first_spring = 0;       ///< its index among all limited springs; the others follow row by row
  double rest_length = 0, limit = 0;  ///< m; limit: largest permitted length
  int width() const { return end - begin; }
};

struct GridPlan {
  int rows = 0, columns = 0;
  int padding = 0;  ///< rows and columns of padding on every side
  int stride = 0;   ///< array elements in each row, padding included
  std::vector<GridFamily> families;

  /// The array index of a particle, or of the spring that begins there.
  std::ptrdiff_t index(int row, int column) const {
    return static_cast<std::ptrdiff_t>(row + padding) * stride + column + padding;
  }
  /// Elements of an array.
  std::size_t size() const {
    return static_cast<std::size_t>(rows + 2 * padding) * static_cast<std::size_t>(stride);
  }
  /// From the index of a spring's first particle to that of its second.
  std::ptrdiff_t offset(const GridFamily& family) const {
    return static_cast<std::ptrdiff_t>(family.down) * stride + family.across;
  }
};

/// The plan for a grid of at least five rows and columns whose limited springs are complete families: each
/// direction that occurs has all its springs. Otherwise nullopt.
std::optional<GridPlan> plan_grid(const std::vector<TensionSpring>& springs, const ClothSystem& system);

}  // namespace cloth
