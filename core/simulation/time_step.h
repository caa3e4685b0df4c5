// The time step of a run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "scene/scene.h"

namespace cloth {

/// "auto" uses these fractions of the method's stability limits, for the flat cloth and for every shape of
/// it.
inline constexpr double auto_flat_fraction = 0.8, auto_guaranteed_fraction = 0.95;

/// The scene's step in s, or the one that "auto" means: the largest one that divides the record interval
/// into whole steps and is not above 80 % of the flat cloth's limit nor 95 % of the guaranteed one; of Verlet
/// on a grid with dampers and without continuous contact one step more to an interval, where that lets it
/// predict its damping (predicted_damping_load() of measure/stability_limit.h). nullopt where the method has
/// no stable step for the scene.
std::optional<double> resolved_time_step(const Scene& scene);

/// `time_step` where it divides `interval` into whole steps; else the longest shorter one that does. s
double step_dividing(double interval, double time_step);

/// A message that says why "auto" finds no stable step for this scene.
std::string no_stable_step_text(const Scene& scene);

/// A message where the scene's own step is not below stable_step(), so that motions grow that the cloth does
/// not make; else empty. A deformation rate or contact can hide that.
std::string too_long_step_text(const Scene& scene);

/// Steps between two rows of a recording: the interval in steps, rounded, at least 1.
std::int64_t steps_per_row(double record_interval, double time_step);

/// Steps that cover `duration`, max_steps_of_run at most.
std::int64_t steps_to_cover(double duration, double time_step);

/// A message where the duration is not a whole number of steps, so that the last step goes beyond it; else
/// empty.
std::string uneven_duration_text(double duration, double time_step);

}  // namespace cloth
