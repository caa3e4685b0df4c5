// The two Euler methods with one evaluation of the force.
#pragma once

#include "integrators/integrator.h"

namespace cloth {

/// x' = x + h v, v' = v + h a(x, v, t): order 1, unstable for every undamped oscillation.
class ExplicitEuler : public Integrator {
 public:
  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;

 private:
  Vec3Field force_;
};

/// v' = v + h a(x, v, t), x' = x + h v', Eqs. (5)-(7) of the report, which calls it implicit Euler: order 1,
/// symplectic without damping.
class SemiImplicitEuler : public Integrator {
 public:
  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  bool set_drift_constraint(DriftConstraint* constraint) override {
    constraint_ = constraint;
    return true;
  }

 private:
  DriftConstraint* constraint_ = nullptr;
  Vec3Field force_;
};

}  // namespace cloth
