#include "study/step_ladder.h"

#include <algorithm>
#include <cmath>

#include "measure/stability_limit.h"
#include "scene/scene_cloth.h"

namespace cloth {
namespace {

constexpr double periods = 150;
constexpr double implicit_step = 1.0 / 60;  // s
constexpr double far_below = 0.05;          // of 1/omega
constexpr double newton_tolerance = 1e-8;   // relative, of the last change
constexpr double under = 0.999, beyond = 1.15;

double omega_of(const Scene& scene) {
  return largest_frequency(scene);
}

std::int64_t round_up(std::int64_t value, std::int64_t to) {
  return std::max<std::int64_t>(1, (value + to - 1) / to) * to;
}

/// Far more than anybody can wait for; the finest rung's are still a 64-bit number.
constexpr double max_ladder_steps = 1e14;

std::int64_t steps_for(double horizon, double step) {
  return static_cast<std::int64_t>(
      std::clamp(std::ceil(horizon / step * (1 - 1e-12)), 1.0, max_ladder_steps));
}

/// The step of rung 0 before the horizon is divided by it, in s.
double first_step(const StepLadder& ladder, double omega, double horizon) {
  const double fastest = omega > 0 ? 1 / omega : horizon / 50;
  if (!ladder.limit || *ladder.limit < far_below * fastest) return 0.4 * fastest;
  if (std::isfinite(*ladder.limit)) return under * *ladder.limit;
  return std::min(horizon / 5, std::max(implicit_step, 4 * fastest));
}

int choose_samples(const std::vector<std::int64_t>& steps) {
  for (const int samples : {50, 40, 25, 20, 10, 8})
    if (std::all_of(steps.begin(), steps.end(), [&](std::int64_t n) {
          return static_cast<double>(round_up(n, samples)) <= 1.1 * static_cast<double>(n);
        }))
      return samples;
  return 5;
}

}  // namespace

double default_horizon(const Scene& scene) {
  const double omega = omega_of(scene);
  const double longest = omega > 0 ? periods * 2 * M_PI / omega : scene.duration;
  if (longest >= scene.duration) return scene.duration;
  const double power = std::pow(10, std::floor(std::log10(longest)));
  double horizon = power;
  for (const double digits : {1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (digits * power <= longest) horizon = digits * power;
  return horizon;
}

std::int64_t StepLadder::steps(int rung) const {
  if (rung < 0) return beyond_steps;
  return by_tolerance ? first_steps : first_steps << rung;
}

double StepLadder::tolerance(int rung) const {
  return by_tolerance ? std::pow(10.0, -2 - rung) : 0;
}

Ladders make_ladders(const Scene& scene, const std::vector<std::string>& methods, double horizon) {
  Ladders ladders{.horizon = horizon, .samples = 0, .methods = {}};
  const double omega = omega_of(scene);
  std::vector<std::int64_t> wanted;
  for (const std::string& name : methods) {
    StepLadder ladder{.facts = facts_of(name), .limit = stable_step(name, scene)};
    ladder.by_tolerance = ladder.facts.settings == MethodSettings::error_control;
    if (ladder.by_tolerance)
      ladder.limit = infinity;
    else
      wanted.push_back(steps_for(horizon, first_step(ladder, omega, horizon)));
    ladders.methods.push_back(ladder);
  }
  ladders.samples = choose_samples(wanted);
  std::size_t k = 0;
  for (StepLadder& ladder : ladders.methods) {
    ladder.first_steps = ladder.by_tolerance ? ladders.samples : round_up(wanted[k++], ladders.samples);
    if (ladder.by_tolerance || !ladder.limit || !std::isfinite(*ladder.limit)) continue;
    const auto longest =
        static_cast<std::int64_t>(std::min(horizon / (beyond * *ladder.limit), max_ladder_steps));
    const std::int64_t steps = longest / ladders.samples * ladders.samples;
    if (steps > 0 && steps < ladder.first_steps) ladder.beyond_steps = steps;
  }
  return ladders;
}

Scene scene_at(const Scene& scene, const StepLadder& ladder, int rung, double horizon) {
  Scene result = scene;
  result.integrator.method = ladder.facts.name;
  result.integrator.time_step = horizon / static_cast<double>(ladder.steps(rung));
  if (ladder.facts.settings == MethodSettings::newton) result.integrator.tolerance = newton_tolerance;
  if (ladder.by_tolerance) result.integrator.tolerance = ladder.tolerance(rung);
  return result;
}

}  // namespace cloth
