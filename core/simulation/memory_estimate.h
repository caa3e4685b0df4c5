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

/// How many runs like the largest of these fit into the memory that there is, at once: at most `most`, at
/// least one. No scene: `most`.
int runs_that_fit(const std::vector<Scene>& scenes, int most);

}  // namespace cloth
