#include "simulation/time_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contact/continuous_contact.h"
#include "measure/stability_limit.h"
#include "scene/scene_checks.h"
#include "simulation/predicted_damping.h"

namespace cloth {
namespace {

// 0.1 / 0.001 is not quite 100: quotients this close to a whole number are that number.
constexpr double whole_number_slack = 1e-9;

/// At least 1. Beyond max_steps_of_run nothing is counted any more, and no double is cast that a whole
/// number could not hold.
std::int64_t whole_steps(double steps) {
  return static_cast<std::int64_t>(std::clamp(steps, 1.0, max_steps_of_run));
}

}  // namespace

std::optional<double> resolved_time_step(const Scene& scene) {
  if (scene.integrator.time_step) return scene.integrator.time_step;
  // Error control divides steps as the forces ask for it, but the deformation rate acts at their ends. With
  // contact particle by particle the energy errs several times more at the record interval (docs/contact.md).
  Scene limited = scene;
  if (scene.deformation || (!scene.obstacles.empty() && !has_continuous_contact(scene)))
    limited.integrator.tolerance = 0;
  const auto limit = stable_step(scene.integrator.method, limited);
  if (!limit) return std::nullopt;
  const double guaranteed = guaranteed_step(scene.integrator.method, limited).value_or(0);
  if (!(guaranteed > 0)) return std::nullopt;
  const double longest = std::min(auto_flat_fraction * *limit, auto_guaranteed_fraction * guaranteed);
  const double interval = scene.record.interval;
  if (longest >= interval) return interval;
  return interval / parts_to_predict(scene, interval, std::ceil(interval / longest));
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

std::string too_long_step_text(const Scene& scene) {
  const std::string& method = scene.integrator.method;
  const double step = scene.integrator.time_step.value_or(0), limit = stable_step(method, scene).value_or(0);
  if (!(step > 0) || step < limit) return "";
  if (!(limit > 0))
    return fmt::format("integrator.time_step = {:.6g} s: {} is stable at no step for this scene", step,
                       method);
  return fmt::format(
      "integrator.time_step = {:.6g} s is beyond the {:.6g} s up to which {} is stable for this scene", step,
      limit, method);
}

std::int64_t steps_per_row(double record_interval, double time_step) {
  return whole_steps(std::round(record_interval / time_step));
}

std::int64_t steps_to_cover(double duration, double time_step) {
  return whole_steps(std::ceil(duration / time_step * (1 - whole_number_slack)));
}

std::string uneven_duration_text(double duration, double time_step) {
  const double parts = duration / time_step, whole = std::max(1.0, std::round(parts));
  if (std::abs(parts - whole) <= whole_number_slack * whole || parts > max_steps_of_run) return "";
  const std::int64_t steps = steps_to_cover(duration, time_step);
  return fmt::format("duration = {:.6g} s is no whole number of steps of {:.6g} s: it takes {} {}, {:.6g} s",
                     duration, time_step, steps, steps == 1 ? "step" : "steps",
                     static_cast<double>(steps) * time_step);
}

}  // namespace cloth
