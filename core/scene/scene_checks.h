// The rules that a scene must keep, whatever it was made from.
#pragma once

#include <optional>
#include <string>

#include "params/problem.h"
#include "scene/scene.h"

namespace cloth {

/// Every broken rule, without places. Empty: the scene can be assembled.
std::vector<Problem> find_problems(const Scene& scene);

/// What is unusual about a scene that can be assembled all the same, a sentence each: of its meshes
/// (mesh_notices), and thicknesses that are next to nothing beside the cloth's cells.
std::vector<std::string> scene_notices(const Scene& scene);

/// A run of more steps is refused: at 10 ns a step it would take hours for a single particle.
inline constexpr double max_steps_of_run = 1e12;

/// The rule that a run of `duration` in steps of `time_step` breaks, in words; nothing if it has at most
/// max_steps_of_run. Reckoned in doubles, in which no quotient is too large.
std::optional<std::string> too_many_steps(double duration, double time_step);

}  // namespace cloth
