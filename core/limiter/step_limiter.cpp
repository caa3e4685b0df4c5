#include "limiter/step_limiter.h"

namespace cloth {

void StepLimiter::begin(double time_step) {
  time_step_ = time_step;
  report_ = {};
  work_ = 0;
}

void StepLimiter::begin_step(double time_step, const ClothState& state, bool drifts_with_end_velocity) {
  begin(time_step);
  drifts_with_end_velocity_ = drifts_with_end_velocity;
  if (drifts_with_end_velocity) start_velocity_ = state.velocity;
}

bool StepLimiter::apply(ClothState& state) {
  report_ = {.sweeps = 0, .direct_iterations = 0, .excess = limiter_.excess(state.position)};
  if (limiter_.accepts(report_.excess)) return false;
  report_ = limiter_.apply(*system_, time_step_, state);
  return true;
}

void StepLimiter::before_kick(const ClothState& state) {
  start_velocity_ = state.velocity;
}

/// The kinetic energy that the impulses p add to the velocity v with which the step began, p (v + p/(2 m)).
/// So counted, Verlet keeps its balance of energy up to a term of order h^2 that swings and does not grow.
void StepLimiter::after_drift(ClothState& state) {
  if (apply(state)) work_ = limiter_.impulse_work(*system_, time_step_, start_velocity_, state);
}

/// A method that drifts with its end velocity takes the impulse along: it works on the mean of the
/// velocities at the step's begin and end. Otherwise what is moved after the step has done its work at once.
bool StepLimiter::after_step(const Vec3& gravity, ClothState& state) {
  if (limiter_.accepts(report_.excess = limiter_.excess(state.position))) return false;
  if (drifts_with_end_velocity_) {
    const auto start = start_velocity_.flat();
    const auto end = state.velocity.flat();
    for (std::size_t k = 0; k < start.size(); ++k) start[k] = 0.5 * (start[k] + end[k]);
  }
  report_ = limiter_.apply(*system_, time_step_, state);
  work_ = drifts_with_end_velocity_ ? limiter_.impulse_work(*system_, time_step_, start_velocity_, state)
                                    : limiter_.work(*system_, gravity, time_step_, state);
  return true;
}

void StepLimiter::limit_start(double time_step, ClothState& state) {
  begin(time_step);
  const Vec3Field velocity = state.velocity;
  apply(state);
  state.velocity = velocity;
  report_ = {};
}

}  // namespace cloth
