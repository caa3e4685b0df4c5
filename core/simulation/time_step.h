// The step a scene is run with.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scene/scene.h"

namespace cloth {

/// "auto" stays at this part of the method's stability limit.
inline constexpr double auto_fraction = 0.8;

/// The scene's step in s, or the one that "auto" means: the largest one not above 80 % of the limit that
/// divides the record interval into whole steps. nullopt where the method has no stable step for the scene.
std::optional<double> resolved_time_step(const Scene& scene);

/// `time_step` where it divides `interval` into whole steps; else the longest shorter one that does. s
double step_dividing(double interval, double time_step);

/// Why `auto` has no answer for this scene, in words.
std::string no_stable_step_text(const Scene& scene);

/// Steps between two rows of a recording: the interval in steps, rounded, at least 1.
std::int64_t steps_per_row(double record_interval, double time_step);

/// Steps that cover `duration`.
std::int64_t steps_to_cover(double duration, double time_step);

}  // namespace cloth
