#include "cloth/cut_grid.h"

namespace cloth {
namespace {

/// Of a cell's middle, from the middle of the sheet, over half of the sheet's side.
double share_of(int index, int count) {
  return (2 * index + 1.0) / (count - 1) - 1;
}

bool is_left(const ClothSheet& sheet, int row, int column) {
  if (!sheet.is_cut()) return true;
  const double x = share_of(column, sheet.columns), y = share_of(row, sheet.rows);
  return x * x + y * y <= 1;
}

}  // namespace

CutGrid cut_grid(const ClothSheet& sheet) {
  CutGrid grid{.rows = sheet.rows, .columns = sheet.columns, .cells = {}, .particle = {}, .place = {}};
  for (int row = 0; row + 1 < sheet.rows; ++row)
    for (int column = 0; column + 1 < sheet.columns; ++column)
      grid.cells.push_back(is_left(sheet, row, column));
  grid.particle.assign(static_cast<std::size_t>(sheet.rows) * static_cast<std::size_t>(sheet.columns), -1);
  for (int row = 0; row < sheet.rows; ++row)
    for (int column = 0; column < sheet.columns; ++column) {
      if (grid.cells_around(row, column) == 0) continue;
      const int place = row * sheet.columns + column;
      grid.particle[static_cast<std::size_t>(place)] = static_cast<int>(grid.place.size());
      grid.place.push_back(place);
    }
  return grid;
}

int particle_count(const ClothSheet& sheet) {
  if (!sheet.is_cut()) return sheet.rows * sheet.columns;
  return static_cast<int>(cut_grid(sheet).place.size());
}

}  // namespace cloth
