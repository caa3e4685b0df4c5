// Edits of a cloth as plain functions: another kind of cloth, what a click on a particle means, and what a
// smaller grid leaves.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace clothlab {

/// m: of a grid its middle, of a mesh that is loaded that of its bounds.
cloth::Vec3 middle_of(const cloth::ClothSheet& sheet);

/// A grid of the default fineness about where a mesh was and as large: upright if the mesh is higher than
/// deep, else level. Without pins; its mass stays.
cloth::ClothSheet grid_in_place_of(const cloth::ClothSheet& mesh);

/// Whether any pin, named or not, holds the particle.
bool is_pinned(const cloth::ClothSheet& sheet, int row, int column);

/// The pins after the particle was pinned or freed. Freeing a particle of a named edge turns that edge into
/// pins of its other particles; pinning a corner uses the corner's name, so that it stays the corner when the
/// grid changes.
std::vector<cloth::Pin> toggled_pins(const cloth::ClothSheet& sheet, int row, int column);

/// The pins that name something inside the grid.
std::vector<cloth::Pin> pins_inside(const cloth::ClothSheet& sheet);

}  // namespace clothlab
