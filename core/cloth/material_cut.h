// A cloth of a material that is cut from a grid.
#pragma once

#include "cloth/cloth_sheet.h"
#include "cloth/cloth_system.h"
#include "cloth/material.h"

namespace cloth {

/// The cells of cut_grid(), assembled as in cloth/material_grid.h, as a mesh: one row of particles, numbered
/// as in cut_grid(), and two triangles for each cell. An edge has half of its springs from each cell that it
/// borders on; a bending element along a line has the stiffness of cell_bending() times the quarters of cells
/// around its middle that exist. So the mass is the areal density times the area of the cells, and a strain
/// that is the same everywhere leaves no net force inside. Precondition: no negative spring.
ClothSystem make_material_cut(const ClothSheet& sheet, const Material& material);

}  // namespace cloth
