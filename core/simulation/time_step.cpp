#include "simulation/time_step.h"

#include <algorithm>
#include <cmath>

#include "measure/stability_limit.h"

namespace cloth {
namespace {

// 0.1 / 0.001 is not quite 100: quotients this close to a whole number are that number.
constexpr double whole_number_slack = 1e-9;

}  // namespace

std::optional<double> resolved_time_step(const Scene& scene) {
  if (scene.integrator.time_step) return scene.integrator.time_step;
  const auto limit = stable_step(scene.integrator.method, scene);
  if (!limit) return std::nullopt;
  const double guaranteed = guaranteed_step(scene.integrator.method, scene).value_or(0);
  if (!(guaranteed > 0)) return std::nullopt;
  const double longest = std::min(auto_flat_fraction * *limit, auto_guaranteed_fraction * guaranteed);
  const double interval = scene.record.interval;
  if (longest >= interval) return interval;
  return interval / std::ceil(interval / longest);
}

double step_dividing(double interval, double time_step) {
  const double parts = interval / time_step;
  const double whole = std::round(parts);
  if (whole >= 1 && std::abs(parts - whole) <= whole_number_slack * whole) return time_step;
  return interval / std::ceil(parts);
}

std::string no_stable_step_text(const Scene& scene) {
  return "integrator.time_step = \"auto\": " + scene.integrator.method +
         " has no stable time step for this scene: it amplifies every motion that is not damped, and the "
         "scene has no "
         "viscous damping; add \"damping\" or choose another method";
}

std::int64_t steps_per_row(double record_interval, double time_step) {
  return std::max<std::int64_t>(1, std::llround(record_interval / time_step));
}

std::int64_t steps_to_cover(double duration, double time_step) {
  const double steps = duration / time_step;
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(steps * (1 - whole_number_slack))));
}

}  // namespace cloth
