#include "integrators/step_equation.h"

namespace cloth {

void find_step_residual(ForceModel& forces, const StepTimes& times, const Vec3Field& start_velocity,
                        const ClothState& end, Vec3Field& force, Vec3Field& residual) {
  const ClothSystem& system = forces.system();
  const double h = times.step;
  forces.update(end.position, times.end);
  forces.force(end.position, end.velocity, force);
  const double* v[] = {end.velocity.x(), end.velocity.y(), end.velocity.z()};
  const double* start[] = {start_velocity.x(), start_velocity.y(), start_velocity.z()};
  const double* f[] = {force.x(), force.y(), force.z()};
  double* r[] = {residual.x(), residual.y(), residual.z()};
  const double* mass = system.mass.data();
  const double* inverse = system.inverse_mass.data();
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < residual.size(); ++i) {
      const double left = mass[i] * (v[axis][i] - start[axis][i]) - h * f[axis][i];
      r[axis][i] = inverse[i] == 0 ? 0 : left;
    }
}

void LeftStep::note(const Vec3Field& start_velocity, const ClothState& end) {
  start_velocity_ = start_velocity;
  end_.position = end.position;
  end_.velocity = end.velocity;
}

const Vec3Field& LeftStep::force_left(ForceModel& forces, const StepTimes& times) {
  if (left_.size() != end_.position.size()) left_ = force_ = Vec3Field(end_.position.size());
  find_step_residual(forces, times, start_velocity_, end_, force_, left_);
  for (double& value : left_.flat()) value /= times.step;
  return left_;
}

}  // namespace cloth
