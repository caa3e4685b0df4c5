// Whether there is memory for a run, asked before anything is assembled: a system that lends memory which it
// does not have ends the process later, without a word.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace cloth {

/// That a run needs more memory than this process can have, in words; nothing where it can have it.
std::optional<std::string> memory_problem(const Scene& scene);

/// The same of runs that are all in memory at once, as the panes of a comparison.
std::optional<std::string> memory_problem(const std::vector<Scene>& scenes);

}  // namespace cloth
