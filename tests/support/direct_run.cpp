#include "support/direct_run.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cloth/grid.h"
#include "cloth/mesh_cloth.h"
#include "integrators/registry.h"
#include "scene/scene_cloth.h"

namespace cloth::test {

IntegratorChoice exactly(const std::string& method, std::optional<double> time_step, double w) {
  constexpr double rounding = 1e-16;
  constexpr int most = 30;
  IntegratorChoice choice{method, time_step};
  choice.tolerance = facts_of(method).settings == MethodSettings::error_control ? 0 : 1e-12;
  const double needed = w < 1 ? std::ceil(std::log(rounding) / (2 * std::log(w))) + 2 : most;
  const int iterations = static_cast<int>(std::min<double>(needed, most));
  choice.projective_iterations = choice.xpbd_iterations = choice.vbd_iterations = iterations;
  choice.substeps = 1;
  return choice;
}

DirectRun::DirectRun(const Scene& scene, const IntegratorChoice& choice)
    : DirectRun(make_cloth(scene), scene, choice) {}

DirectRun::DirectRun(ClothSystem made, const Scene& scene, const IntegratorChoice& choice)
    : system(std::move(made)), state(starting_state(system)), forces(scene, system), choice_(choice) {}

Integrator& DirectRun::integrator() {
  const StepperKind kind = stepper_kind(choice_.method, forces, {.end_velocity = end_velocity_});
  if (!integrator_ || kind != kind_) integrator_ = make_stepper(choice_, kind);
  kind_ = kind;
  return *integrator_;
}

void DirectRun::advance(int steps, double step) {
  for (int n = 0; n < steps; ++n) {
    const auto now = static_cast<double>(state.step);
    const StepTimes times{now * step, (now + 1) * step, step};
    const IntegratorReport report = integrator().step(forces, times, state, work);
    if (report.failure) throw std::runtime_error(report.failure->cause);
    force_evaluations += report.force_evaluations;
    inner_steps += report.inner_steps;
    rejected_steps += report.rejected_steps;
    ++state.step;
    state.time = times.end;
  }
}

Vec3Field DirectRun::acceleration() {
  Vec3Field force(state.position.size()), result(state.position.size());
  forces.update(state.position, state.time);
  forces.force(state.position, state.velocity, force);
  add_acceleration(system, 1, force, result);
  return result;
}

double left_of_the_step_equations(DirectRun& run, double h) {
  const ClothState start = run.state;
  run.advance(1, h);
  Vec3Field force(start.position.size());
  run.forces.update(run.state.position, h);
  run.forces.force(run.state.position, run.state.velocity, force);
  double left = 0, gained = 0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (run.system.pinned[i]) continue;
    const Vec3 momentum = run.system.mass[i] * (run.state.velocity[i] - start.velocity[i]);
    left = std::max(left, (momentum - h * force[i]).norm());
    gained = std::max(gained, momentum.norm());
  }
  return left / gained;
}

}  // namespace cloth::test
