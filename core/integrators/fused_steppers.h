// Explicit methods whose steps the kernels do whole: force and motion in one pass over the particles
// (kernels/spring_sweep.h). They compute what the general methods of euler.h, verlet.h and rk4.h do, to
// rounding, and serve the same scenes as long as the kernels know every force (ForceModel::is_swept_whole());
// Euler's take others as a load.
// The registry chooses them; see make_stepper().
#pragma once

#include <array>

#include "integrators/euler.h"
#include "integrators/rk4.h"
#include "integrators/verlet.h"

namespace cloth {

/// Semi-implicit Euler, or explicit Euler (`drift_first`).
class FusedEuler : public Integrator {
 public:
  explicit FusedEuler(bool drift_first) : drift_first_(drift_first) {}
  static bool suits(const ForceModel& forces, bool) { return forces.sweeps_steps(); }

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  bool gains_from_batches(const ForceModel& forces) const override;
  IntegratorReport step_many(ForceModel& forces, double step, std::span<double> speed_squares,
                             ClothState& state, Work& work) override;

 private:
  bool drift_first_;
  Vec3Field load_;  ///< N, of the forces that the kernels do not know
};

/// Semi-implicit Euler. A step in which a constraint holds particles is one of the general method.
class FusedSemiImplicitEuler : public FusedEuler {
 public:
  FusedSemiImplicitEuler() : FusedEuler(false) {}

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  bool gains_from_batches(const ForceModel& forces) const override {
    return !constraint_ && FusedEuler::gains_from_batches(forces);
  }
  bool set_drift_constraint(DriftConstraint* constraint) override {
    constraint_ = constraint;
    return general_.set_drift_constraint(constraint);
  }

 private:
  DriftConstraint* constraint_ = nullptr;
  SemiImplicitEuler general_;
};

/// Without dampers along springs, air and constraints, whose kicks need the force field of the general
/// method.
class FusedVerlet : public Verlet {
 public:
  static bool suits(const ForceModel& forces, bool constrained);

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  bool gains_from_batches(const ForceModel&) const override { return holds_position_force_; }
  IntegratorReport step_many(ForceModel& forces, double step, std::span<double> speed_squares,
                             ClothState& state, Work& work) override;

 protected:
  void evaluate(ForceModel& forces, const ClothState& state) override;
};

class FusedRk4 : public Integrator {
 public:
  static bool suits(const ForceModel& forces, bool) { return forces.is_swept_whole(); }

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  bool gains_from_batches(const ForceModel& forces) const override;
  IntegratorReport step_many(ForceModel& forces, double step, std::span<double> speed_squares,
                             ClothState& state, Work& work) override;

 private:
  void sweep(ForceModel& forces, const std::array<double, kutta_stages>& times, double step,
             std::span<double> speed_squares, ClothState& state, Work& work);

  std::vector<StageSums> sums_;  ///< scratch
};

}  // namespace cloth
