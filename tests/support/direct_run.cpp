#include "support/direct_run.h"

#include "cloth/grid.h"
#include "integrators/registry.h"

namespace cloth::test {

DirectRun::DirectRun(const Scene& scene, const IntegratorChoice& choice)
    : system(make_grid(scene.cloth, scene.springs.value_or(SpringMaterial{}))),
      state(starting_state(system)),
      forces(scene, system),
      integrator_(make_integrator(choice)) {}

void DirectRun::advance(int steps, double step) {
  for (int n = 0; n < steps; ++n) {
    const auto now = static_cast<double>(state.step);
    const StepTimes times{now * step, (now + 1) * step, step};
    force_evaluations += integrator_->step(system, forces, times, state, work).force_evaluations;
    ++state.step;
    state.time = times.end;
  }
}

Vec3Field DirectRun::acceleration() {
  Vec3Field force(state.position.size()), result(state.position.size());
  forces.update(state.position, state.time);
  forces.force(state.velocity, force);
  add_acceleration(system, 1, force, result);
  return result;
}

}  // namespace cloth::test
