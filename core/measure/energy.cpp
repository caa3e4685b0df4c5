#include "measure/energy.h"

#include "cloth/sums.h"
#include "forces/gravity.h"
#include "forces/springs.h"

namespace cloth {

double kinetic_energy(const ClothSystem& system, const Vec3Field& velocity) {
  const double *m = system.mass.data(), *vx = velocity.x(), *vy = velocity.y(), *vz = velocity.z();
  return 0.5 * ordered_sum(velocity.size(), [=](std::size_t i) {
           return m[i] * (vx[i] * vx[i] + vy[i] * vy[i] + vz[i] * vz[i]);
         });
}

Energy measure_energy(const ClothSystem& system, const Vec3& gravity_acceleration, const ClothState& state) {
  Energy energy;
  energy.kinetic = kinetic_energy(system, state.velocity);
  energy.elastic_by_family = elastic_energy(system, state.position);
  energy.elastic_by_family[0] += membrane_energy(system.membrane, state.position);
  for (const double part : energy.elastic_by_family) energy.elastic += part;
  energy.bending = bending_energy(system.bending, state.position);
  energy.elastic += energy.bending;
  energy.gravity = gravity_energy(system, gravity_acceleration, state.position);
  return energy;
}

}  // namespace cloth
