// Checks before a run is assembled whether there is enough memory: a system that overcommits memory would end
// the process later without a message.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace cloth {

/// A message where a run of the scene needs more memory than this process can have; else nothing.
std::optional<std::string> memory_problem(const Scene& scene);

/// The same of runs that are all in memory at once, as the panes of a comparison.
std::optional<std::string> memory_problem(const std::vector<Scene>& scenes);

}  // namespace cloth
