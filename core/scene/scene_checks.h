// The rules that a scene must keep, whatever it was made from.
#pragma once

#include "scene/problem.h"
#include "scene/scene.h"

namespace cloth {

/// Every broken rule, without places. Empty: the scene can be assembled.
std::vector<Problem> find_problems(const Scene& scene);

}  // namespace cloth
