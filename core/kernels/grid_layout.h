// Which cloths the kernels for grids take, and what they need to know of them.
#pragma once

#include <optional>
#include <vector>

#include "cloth/cloth_system.h"
#include "kernels/grid_pass.h"

namespace cloth {

/// The six directions of springs of `system` if they are those of make_grid; whole families may be absent.
std::optional<kernels::Grid> grid_springs(const ClothSystem& system);

/// A grid whose masses, springs and bending elements are shares of cells, as make_material_grid makes them.
struct CellLayout {
  kernels::Grid grid;                       ///< the springs inside
  double mass = 0;                          ///< kg, of a particle inside
  std::vector<double> part;                 ///< see kernels::CellShares
  std::vector<double> across, down, twist;  ///< N/m, likewise; empty: the cloth does not bend
  kernels::CellShares shares() const;
};
/// Nothing where `system` is another one.
std::optional<CellLayout> cell_layout(const ClothSystem& system);

}  // namespace cloth
