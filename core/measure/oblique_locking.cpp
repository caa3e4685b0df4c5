#include "measure/oblique_locking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "cloth/cut_grid.h"
#include "scene/scene_cloth.h"

namespace cloth {

double locking_ratio(const Material& material, double across, double down, double curvature) {
  const double bending = bending_at(material, std::numbers::pi / 4);
  const CellSprings k = cell_springs(material, across, down);
  if (!(bending > 0) || !(k.across > 0) || !(k.down > 0)) return 0;
  const double giving_way = 1 + material.shear * (1 / k.across + 1 / k.down);
  return material.shear * std::pow(across * down * curvature, 2) / (128 * bending * giving_way);
}

ObliqueLocking measure_oblique_locking(const Scene& scene, [[maybe_unused]] const ClothSystem& system,
                                       const Vec3Field& position) {
  ObliqueLocking locking;
  if (!scene.material || scene.cloth.is_mesh()) return locking;
  const CellSides cell = cell_sides(scene.cloth);
  const CutGrid grid = cut_grid(scene.cloth);
  assert(static_cast<int>(grid.place.size()) == system.size());
  std::size_t above = 0, cells = 0;
  for (int row = 0; row + 1 < grid.rows; ++row)
    for (int column = 0; column + 1 < grid.columns; ++column) {
      if (!grid.has_cell(row, column)) continue;
      const auto at = [&](int r, int c) {
        return position[static_cast<std::size_t>(grid.at(row + r, column + c))];
      };
      const double twist =
          (at(0, 0) - at(0, 1) - at(1, 0) + at(1, 1)).norm() / (cell.across * cell.down);  // 1/m
      const double ratio = locking_ratio(*scene.material, cell.across, cell.down, 2 * twist);
      locking.largest = std::max(locking.largest, ratio);
      ++cells;
      if (ratio > locking_warned_of) ++above;
    }
  locking.cells_above = static_cast<double>(above) / static_cast<double>(cells);
  return locking;
}

std::string locking_text(const Scene& scene, const ObliqueLocking& locking) {
  constexpr double few = 0.01;
  if (!(locking.cells_above > few)) return {};
  const CellSides cell = cell_sides(scene.cloth);
  return fmt::format(
      "{:.0f} % of the cells, {:.3g} m by {:.3g} m, are too large for how the cloth bends across the grid in "
      "the "
      "end: there it is stiffer than its material by {:.2g} times its bending and more, at most {:.2g} times",
      100 * locking.cells_above, cell.across, cell.down, locking_warned_of, locking.largest);
}

}  // namespace cloth
