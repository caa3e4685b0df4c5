// Whether a scene starts free of crossings: what continuous contact keeps it must find.
#pragma once

#include <vector>

#include "scene/scene.h"

namespace cloth {

/// A problem for each obstacle that the cloth touches at t = 0, with the first place found, and one where the
/// cloth passes through itself although self_contact forbids it. Nothing where contact is not continuous.
/// Precondition: the scene has no other problems.
std::vector<Problem> find_start_problems(const Scene& scene);

}  // namespace cloth
