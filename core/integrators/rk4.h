// The classical Runge-Kutta method of order 4 (Kutta 1901): y' = y + h/6 (k1 + 2 k2 + 2 k3 + k4) for y = (x,
// v, work). The source report's Eq. (8) prints 3 k3, whose weights sum to 7/6: that does not converge.
#pragma once

#include <array>

#include "integrators/integrator.h"
#include "integrators/kick_impulse.h"
#include "kernels/kutta.h"

namespace cloth {

/// s, of the method's evaluations of the force.
std::array<double, kutta_stages> kutta_times(const StepTimes& times);

class Rk4 : public Integrator {
 public:
  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  void forget(Change change) override { kicks_are_known_ = kicks_are_known_ && change != Change::state; }
  /// Of dampers, which move within a step with particles that contact has then moved back.
  Work correct_work(ForceModel& forces, const StepTimes& times, const ClothState& state) override;
  /// Whether contact has changed the end of the last step.
  bool follows_contact() const { return has_touched_; }
  IntegratorMemory remember() const override { return {.fields = {}, .numbers = {has_touched_ ? 1.0 : 0.0}}; }
  void recall(const IntegratorMemory& memory) override { has_touched_ = memory.numbers.at(0) != 0; }

 private:
  bool has_touched_ = false;      ///< see follows_contact()
  bool kicks_are_known_ = false;  ///< of the last step, whose end nothing but contact has changed
  KickImpulse kicks_;
  Vec3Field force_;
  Vec3Field stage_position_, stage_velocity_;
  Vec3Field next_position_, next_velocity_;  ///< the state plus the weighted stages so far
};

}  // namespace cloth
