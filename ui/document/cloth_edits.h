// A cloth that becomes another kind of cloth, as plain functions.
#pragma once

#include "scene/scene.h"

namespace clothlab {

/// m: of a grid its middle, of a mesh that is loaded that of its bounds.
cloth::Vec3 middle_of(const cloth::ClothSheet& sheet);

/// A grid of the default fineness about where a mesh was and as large: upright if the mesh is higher than
/// deep, else level. Without pins; its mass stays.
cloth::ClothSheet grid_in_place_of(const cloth::ClothSheet& mesh);

}  // namespace clothlab
