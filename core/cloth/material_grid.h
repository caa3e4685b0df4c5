// A grid cloth of a material: its springs, masses and bending elements, assembled cell by cell.
#pragma once

#include "cloth/cloth_sheet.h"
#include "cloth/cloth_system.h"
#include "cloth/material.h"

namespace cloth {

/// Each cell gives half of its springs to each of its edges, its diagonals whole, and a quarter of its mass
/// to each corner. A bending element has the stiffness of cell_bending() times the part of its cells that
/// exist: half along a border. Clamps: an element whose middle and one end are pinned bends on its free side
/// alone, over half the length, so that its stiffness doubles; so does that of the twist of a cell with three
/// pinned corners. Elements without a free particle are left out. Precondition: no negative spring.
ClothSystem make_material_grid(const ClothSheet& sheet, const Material& material);

}  // namespace cloth
