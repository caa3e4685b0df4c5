// The classical Runge-Kutta method of order 4 (Kutta 1901): y' = y + h/6 (k1 + 2 k2 + 2 k3 + k4) for y = (x,
// v, work). The source report's Eq. (8) prints 3 k3, whose weights sum to 7/6: that does not converge.
#pragma once

#include <array>

#include "integrators/integrator.h"
#include "kernels/kutta.h"

namespace cloth {

/// s, of the method's evaluations of the force.
std::array<double, kutta_stages> kutta_times(const StepTimes& times);

class Rk4 : public Integrator {
 public:
  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;

 private:
  Vec3Field force_;
  Vec3Field stage_position_, stage_velocity_;
  Vec3Field next_position_, next_velocity_;  ///< the state plus the weighted stages so far
};

}  // namespace cloth
