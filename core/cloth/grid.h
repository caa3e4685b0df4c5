// The grid cloth of the model: where its particles start and which springs join them.
#pragma once

#include "cloth/cloth_sheet.h"
#include "cloth/cloth_system.h"

namespace cloth {

/// The vectors from a particle to its right and its lower neighbour at rest, in metres.
struct GridCell {
  Vec3 across, down;
};
GridCell cell_of(const ClothSheet& sheet);

/// The offset (rows, columns) of a spring direction, e.g. (1, 1) for one of the diagonals.
struct SpringDirection {
  SpringFamily family;
  int rows, columns;
};
/// structural (0,1) (1,0); shear (1,1) (1,-1); flexion (0,2) (2,0).
const std::array<SpringDirection, 6>& spring_directions();

/// The springs of one direction in a grid; of no rows where the grid is too small for any. A direction
/// without columns joins whole rows, so that it is a single run. `rest_length` in m, `stiffness` in N/m.
SpringBlock direction_block(const ClothSystem& grid, const SpringDirection& direction, double rest_length,
                            double stiffness);

double stiffness_of(const SpringMaterial& material, SpringFamily family);

/// Gives a system of rows x columns particles equal masses, the sheet's pins, and room for their places.
void give_particles(const ClothSheet& sheet, ClothSystem& system);

ClothSystem make_grid(const ClothSheet& sheet, const SpringMaterial& material);

/// At rest where the sheet starts.
ClothState starting_state(const ClothSystem& system);

}  // namespace cloth
