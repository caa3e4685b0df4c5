// An integrator advances a state by one step of m a = f(x, v, t). It knows neither which forces exist nor
// what comes after it (limiter, contact); the loop owns time.
#pragma once

#include "forces/force_model.h"

namespace cloth {

/// From t to t + h. The end is given, not added up, so that the last bit does not depend on the way there.
struct StepTimes {
  double begin = 0, end = 0, step = 0;  ///< s
};

struct IntegratorReport {
  int force_evaluations = 0;
  int velocity_iterations = 0;  ///< of the solve for centred damping
};

class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Advances position and velocity and adds the work of the forces to `work`, by a quadrature of the
  /// method's own order. Neither `state.time` nor `state.step` is touched.
  virtual IntegratorReport step(const ClothSystem& system, ForceModel& forces, const StepTimes& times,
                                ClothState& state, Work& work) = 0;

  /// Something else has changed the state or the forces: nothing remembered from the last step holds.
  virtual void forget() {}
};

/// to += scale * inverse_mass * force
inline void add_acceleration(const ClothSystem& system, double scale, const Vec3Field& force, Vec3Field& to) {
  const double* inverse_mass = system.inverse_mass.data();
  const double* from[] = {force.x(), force.y(), force.z()};
  double* into[] = {to.x(), to.y(), to.z()};
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < to.size(); ++i) into[axis][i] += scale * inverse_mass[i] * from[axis][i];
}

/// to += scale * from
inline void add_scaled(double scale, const Vec3Field& from, Vec3Field& to) {
  const auto a = from.flat();
  const auto b = to.flat();
  for (std::size_t k = 0; k < b.size(); ++k) b[k] += scale * a[k];
}

}  // namespace cloth
