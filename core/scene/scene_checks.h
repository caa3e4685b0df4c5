// The rules for valid scenes, for scenes from files, forms and code alike.
#pragma once

#include <optional>
#include <string>

#include "params/problem.h"
#include "scene/scene.h"

namespace cloth {

/// All broken rules, without places in a file. If there are none, the scene can be assembled.
std::vector<Problem> find_problems(const Scene& scene);

/// Warnings about a valid scene, a sentence each: about its meshes (mesh_notices), and about thicknesses that
/// are very small compared to the cloth's cells.
std::vector<std::string> scene_notices(const Scene& scene);

/// A run of more steps is refused: at 10 ns a step it would take hours for a single particle.
inline constexpr double max_steps_of_run = 1e12;

/// A message if a run of `duration` (s) in steps of `time_step` (s) has more than max_steps_of_run steps;
/// otherwise nullopt.
std::optional<std::string> too_many_steps(double duration, double time_step);

}  // namespace cloth
