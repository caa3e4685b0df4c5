#include "forces/gravity.h"

#include "cloth/sums.h"

namespace cloth {

void Gravity::update(const ClothSystem& system, const Vec3Field&, double, Vec3Field& force) {
  const Vec3 weight = system.particle_mass * acceleration_;
  double* components[] = {force.x(), force.y(), force.z()};
  for (int axis = 0; axis < 3; ++axis)
    if (weight[axis] != 0)
      for (std::size_t i = 0; i < force.size(); ++i) components[axis][i] += weight[axis];
}

double gravity_energy(const ClothSystem& system, const Vec3& acceleration, const Vec3Field& position) {
  const double* now[] = {position.x(), position.y(), position.z()};
  const double* then[] = {system.start.x(), system.start.y(), system.start.z()};
  double energy = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (acceleration[axis] != 0)
      energy -= acceleration[axis] *
                ordered_sum(position.size(),
                            [x = now[axis], x0 = then[axis]](std::size_t i) { return x[i] - x0[i]; });
  return system.particle_mass * energy;
}

}  // namespace cloth
