// Edits of a cloth as pure functions: changing the kind of cloth, toggling the pin of a particle, and keeping
// the pins that fit a smaller grid.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace clothlab {

/// The middle of a grid, or of the bounding box of a loaded mesh (m).
cloth::Vec3 middle_of(const cloth::ClothSheet& sheet);

/// A grid of the default resolution with the position, size and mass of a mesh, without pins: vertical if the
/// mesh is higher than deep, else horizontal.
cloth::ClothSheet grid_in_place_of(const cloth::ClothSheet& mesh);

/// Whether any pin, named or not, holds the particle at this place of the grid.
bool is_pinned(const cloth::ClothSheet& sheet, int row, int column);

/// The sheet's pins with the pin of this particle added or removed. Freeing a particle of a named edge turns
/// that edge into pins of its other particles; pinning a corner uses the corner's name, so that it stays the
/// corner when the grid changes.
std::vector<cloth::Pin> toggled_pins(const cloth::ClothSheet& sheet, int row, int column);

/// The pins of the sheet whose particles lie inside the grid.
std::vector<cloth::Pin> pins_inside(const cloth::ClothSheet& sheet);

}  // namespace clothlab
