// Explicit methods whose whole step is one pass of the kernels over the particles, force and motion together,
// or two or three that repeat the force (kernels/spring_sweep.h). They agree with the general methods of
// euler.h, verlet.h and rk4.h to rounding. They need kernels that compute every force of the scene
// (ForceModel::is_swept_whole()); only the Euler methods take other forces, as a load. make_stepper() of
// registry.h chooses them.
#pragma once

#include "integrators/euler.h"
#include "integrators/rk4.h"
#include "integrators/verlet.h"

namespace cloth {

/// Methods that carry nothing from one step to the next: a single step and a batch are one call of the
/// kernels.
class FusedStepper : public Integrator {
 public:
  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  bool gains_from_batches(const ForceModel& forces) const override;
  IntegratorReport step_many(ForceModel& forces, double step, std::span<double> speed_squares,
                             ClothState& state, Work& work) override;

 protected:
  explicit FusedStepper(int evaluations) : evaluations_(evaluations) {}
  /// Takes as many steps as there are `speed_squares`, all with time-dependent forces evaluated at `times`.
  virtual void sweep(ForceModel& forces, const StepTimes& times, std::span<double> speed_squares,
                     ClothState& state, Work& work) = 0;

 private:
  int evaluations_;  ///< of the force, in a step
};

/// Semi-implicit Euler, or explicit Euler (`drift_first`).
class FusedEuler : public FusedStepper {
 public:
  explicit FusedEuler(bool drift_first) : FusedStepper(1), drift_first_(drift_first) {}
  static bool suits(const ForceModel& forces, bool) { return forces.sweeps_steps(); }

 protected:
  void sweep(ForceModel& forces, const StepTimes& times, std::span<double> speed_squares, ClothState& state,
             Work& work) override;

 private:
  bool drift_first_;
  Vec3Field load_;              ///< N, of the forces that the kernels do not know
  std::vector<StepSums> sums_;  ///< scratch
};

/// Semi-implicit Euler.
class FusedSemiImplicitEuler : public FusedEuler {
 public:
  FusedSemiImplicitEuler() : FusedEuler(false) {}

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  bool gains_from_batches(const ForceModel& forces) const override {
    return !constraint_ && FusedEuler::gains_from_batches(forces);
  }
  bool set_drift_constraint(DriftConstraint* constraint) override {
    constraint_ = constraint;
    return true;
  }

 private:
  IntegratorReport held_step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work);

  DriftConstraint* constraint_ = nullptr;
  Vec3Field before_;  ///< m/s, scratch
};

/// Only for scenes without dampers along springs, air drag and constraints; with these the kicks need the
/// force of the general method.
class FusedVerlet : public Verlet {
 public:
  static bool suits(const ForceModel& forces, bool constrained);

  /// With damping the pass keeps no force with which the general step could be opened.
  bool waits_for_contact(const ForceModel& forces) const override {
    return !forces.has_damping() && Verlet::waits_for_contact(forces);
  }

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  bool gains_from_batches(const ForceModel&) const override { return holds_position_force_; }
  IntegratorReport step_many(ForceModel& forces, double step, std::span<double> speed_squares,
                             ClothState& state, Work& work) override;

 protected:
  void evaluate(ForceModel& forces, const ClothState& state) override;
};

/// Verlet with every force at a velocity that is not solved for (EndVelocity::predicted, corrected or
/// corrected_twice), dampers along springs and air in the pass: one pass, two or three. With a constraint the
/// first is divided where that acts; a step in which it moves particles is one of the general method where
/// these are many or DampingAt does not know the damping.
class FusedDampedVerlet : public Verlet {
 public:
  explicit FusedDampedVerlet(EndVelocity end) : Verlet(end), evaluations_(evaluations_of(end)) {}
  static bool suits(const ForceModel& forces) {
    return forces.is_swept_whole() && forces.sweep()->takes_predicted();
  }

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  IntegratorReport open_step(ForceModel& forces, const StepTimes& times, ClothState& state,
                             Work& work) override;
  void close_step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work,
                  IntegratorReport& report) override;
  Work correct_work(ForceModel& forces, const StepTimes& times, const ClothState& state) override;

 private:
  int begin_force(ForceModel& forces, double time, ClothState& state);
  Work power_of(const ForceModel& forces, const StepSums& sums) const;
  IntegratorReport constrained_step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                    Work& work);
  void open_constrained(ForceModel& forces, const StepTimes& times, const SweepLoads& loads,
                        ClothState& state);
  void finish(const ForceModel& forces, double half_step, const StepSums& sums, Work& work,
              IntegratorReport& report);
  double power_at_opening(ForceModel& forces, const StepTimes& times, bool is_few, const ClothState& state);
  void find_before(const ForceModel& forces, double step, const ClothState& state);

  const std::span<const VelocityUpdate> evaluations_;  ///< of a step
  ClothState before_;          ///< at the beginning of a step in which a constraint moves particles
  bool keeps_before_ = false;  ///< of the present step
};

/// A step after one whose end contact has changed is the general method's where dampers act: their work then
/// needs the forces of the stages.
class FusedRk4 : public FusedStepper {
 public:
  FusedRk4() : FusedStepper(kutta_stages) {}
  static bool suits(const ForceModel& forces, bool) { return forces.is_swept_whole(); }

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  void forget(Change change) override { general_.forget(change); }
  Work correct_work(ForceModel& forces, const StepTimes& times, const ClothState& state) override;
  IntegratorMemory remember() const override { return general_.remember(); }
  void recall(const IntegratorMemory& memory) override { general_.recall(memory); }

 protected:
  void sweep(ForceModel& forces, const StepTimes& times, std::span<double> speed_squares, ClothState& state,
             Work& work) override;

 private:
  Rk4 general_;
  std::vector<StageSums> sums_;  ///< scratch
};

}  // namespace cloth
