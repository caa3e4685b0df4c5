// A cloth in its present state as a Wavefront OBJ file.
#pragma once

#include <string>

#include "cloth/cloth_system.h"

namespace cloth {

/// A vertex with its normal for each particle, in their order, and the triangles between them; of a grid also
/// texture coordinates, of which the first row is the upper edge. `title` becomes a comment.
std::string cloth_obj(const ClothSystem& system, const ClothState& state, const std::string& title);

/// The title of such a file: the scene's title and the time in s.
std::string title_at(const std::string& scene_title, double time);

}  // namespace cloth
