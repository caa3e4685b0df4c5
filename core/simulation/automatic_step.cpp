#include "simulation/automatic_step.h"

#include <algorithm>
#include <cmath>

#include "measure/stability_limit.h"
#include "scene/method_facts.h"

namespace cloth {
namespace {

constexpr double max_heating = 0.1;  // in energy scales, since the last change
constexpr int max_shortenings = 4;

}  // namespace

bool is_step_watched(const Scene& scene) {
  const std::string& method = scene.integrator.method;
  if (scene.integrator.time_step || !facts_of(method).may_heat) return false;
  return std::isfinite(guaranteed_step(method, scene).value_or(infinity));
}

bool asks_for_shorter(AutomaticStep& automatic, double error) {
  if (error - automatic.least_error > max_heating && automatic.shortened < max_shortenings) {
    automatic.least_error = error;
    ++automatic.shortened;
    return true;
  }
  automatic.least_error = std::min(automatic.least_error, error);
  return false;
}

std::int64_t steps_after_shortening(double interval, double longest, int shortened) {
  constexpr double slack = 1e-9;  // quotients this close to a whole number are that number
  const double steps = std::round(interval / longest) * std::pow(2.0, 0.5 * shortened);
  return static_cast<std::int64_t>(std::ceil(steps * (1 - slack)));
}

}  // namespace cloth
