#include "forces/gravity.h"

#include "cloth/sums.h"

namespace cloth {

void Gravity::update(const ClothSystem& system, const Vec3Field&, double, Vec3Field& force) {
  const double* mass = system.mass.data();
  double* components[] = {force.x(), force.y(), force.z()};
  for (int axis = 0; axis < 3; ++axis) {
    const double g = acceleration_[axis];
    if (g != 0)
      for (std::size_t i = 0; i < force.size(); ++i) components[axis][i] += mass[i] * g;
  }
}

double gravity_energy(const ClothSystem& system, const Vec3& acceleration, const Vec3Field& position) {
  const double* now[] = {position.x(), position.y(), position.z()};
  const double* then[] = {system.start.x(), system.start.y(), system.start.z()};
  double energy = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (acceleration[axis] != 0)
      energy -= acceleration[axis] *
                ordered_sum(position.size(), [m = system.mass.data(), x = now[axis], x0 = then[axis]](
                                                 std::size_t i) { return m[i] * (x[i] - x0[i]); });
  return energy;
}

}  // namespace cloth
