// The rules that a scene must keep, whatever it was made from.
#pragma once

#include "scene/problem.h"
#include "scene/scene.h"

namespace cloth {

/// Every broken rule, without places. Empty: the scene can be assembled.
std::vector<Problem> find_problems(const Scene& scene);

/// What is unusual about a scene that can be assembled all the same, a sentence each: of its meshes
/// (mesh_notices), and thicknesses that are next to nothing beside the cloth's cells.
std::vector<std::string> scene_notices(const Scene& scene);

}  // namespace cloth
