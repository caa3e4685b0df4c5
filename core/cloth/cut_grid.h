// What a cut leaves of a grid: of a round one the cells whose middle lies within the ellipse that fits the
// sheet, and the particles at their corners.
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/cloth_sheet.h"

namespace cloth {

struct CutGrid {
  int rows = 0, columns = 0;        ///< of particles, as the sheet has them
  std::vector<std::uint8_t> cells;  ///< 1 where there is one; (rows - 1) x (columns - 1), row by row
  std::vector<int> particle;        ///< of each place row * columns + column; -1: none is there
  std::vector<int> place;           ///< of each particle; ascending

  /// Whether there is a cell with (row, column) as its corner above and left; false beyond the grid.
  bool has_cell(int row, int column) const {
    return row >= 0 && column >= 0 && row + 1 < rows && column + 1 < columns &&
           cells[static_cast<std::size_t>(row * (columns - 1) + column)] != 0;
  }
  /// The particle at (row, column); -1: none, or beyond the grid.
  int at(int row, int column) const {
    const bool inside = row >= 0 && column >= 0 && row < rows && column < columns;
    return inside ? particle[static_cast<std::size_t>(row * columns + column)] : -1;
  }
  /// How many of the four cells around (row, column) there are.
  int cells_around(int row, int column) const {
    return has_cell(row, column) + has_cell(row - 1, column) + has_cell(row, column - 1) +
           has_cell(row - 1, column - 1);
  }
};

/// All of it where the sheet is not cut. Precondition: a grid of at least 2 x 2.
CutGrid cut_grid(const ClothSheet& sheet);

/// Of a grid what is left of it, of a mesh its vertices.
int particle_count(const ClothSheet& sheet);

}  // namespace cloth
