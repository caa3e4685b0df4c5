// Edits of a cloth's pins as plain functions: what a click on a particle means, and what a smaller grid
// leaves.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace clothlab {

/// Whether any pin, named or not, holds the particle.
bool is_pinned(const cloth::ClothSheet& sheet, int row, int column);

/// The pins after the particle was pinned or freed. Freeing a particle of a named edge turns that edge into
/// pins of its other particles; pinning a corner uses the corner's name, so that it stays the corner when the
/// grid changes.
std::vector<cloth::Pin> toggled_pins(const cloth::ClothSheet& sheet, int row, int column);

/// The pins that name something inside the grid.
std::vector<cloth::Pin> pins_inside(const cloth::ClothSheet& sheet);

}  // namespace clothlab
