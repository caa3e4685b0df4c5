// Velocity Verlet with the damping centred in time. Without velocity-dependent forces its positions are the
// report's Eq. (14), x(t+h) = 2 x(t) - x(t-h) + h^2 a(t).
//
//     v_half = v + h/2 a(x, v, t)
//     x'     = x + h v_half
//     v'     = v_half + h/2 a(x', v', t+h)      solved for v', a is affine in it
//
// The accelerations hold every force of the scene, a = (p - D v) / m (forces/force.h). Every D v, of air drag
// as of viscous and spring damping, enters twice: in the opening kick with the velocity v at t, and in the
// closing kick, where D is part of the linear system that VelocitySolver solves for v' (with known = v_half
// and weight = h/2). Wind is part of p at both times. After continuous contact has moved the positions, the
// closing kick is repeated at the new ones (update_velocity_for_positions()), and once more with the damping
// at the velocities that contact has set (update_velocity_for_damping()).
//
// A constraint of the positions (DriftConstraint) acts between the drift and the closing kick, on x' and
// v_half.
//
// Order 2 with damping, drag and wind. A step costs one force evaluation, and a second one where contact or
// an edit has changed the state since the last step. Stable for omega h < 2 at every damping ratio.
#pragma once

#include "forces/velocity_solver.h"
#include "integrators/integrator.h"

namespace cloth {

class Verlet : public Integrator {
 public:
  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  bool set_drift_constraint(DriftConstraint* constraint) override {
    constraint_ = constraint;
    return true;
  }
  bool velocity_follows_positions() const override { return true; }
  void update_velocity_for_damping(ForceModel& forces, const StepTimes& times, const Vec3Field& half_velocity,
                                   ClothState& state) override;
  void update_velocity_for_positions(ForceModel& forces, const StepTimes& times,
                                     const Vec3Field& half_velocity, ClothState& state) override;
  Work correct_work(ForceModel& forces, const StepTimes& times, const ClothState& state) override;
  void forget(Change) override { holds_position_force_ = holds_force_ = false; }

 protected:
  /// Computes the power and, where forces depend on the velocity, the force p - D v. The positions are those
  /// of the last ForceModel::update.
  virtual void evaluate(ForceModel& forces, const ClothState& state);

  Work power_;                         ///< at the end of the last step
  bool holds_position_force_ = false;  ///< the force model was last updated at the state

 private:
  void keep_damping(const ForceModel& forces, Vec3Field& damping) const;
  double closing_correction(const ForceModel& forces, double step);
  const Vec3Field& force(const ForceModel& forces) const;
  int finish_velocity(ForceModel& forces, double half_step, ClothState& state);

  DriftConstraint* constraint_ = nullptr;
  Vec3Field force_;                              ///< p - D v, N; used only where has_damping()
  Vec3Field opening_damping_, closing_damping_;  ///< -D v in the two kicks, N; used only with a constraint
  double closing_correction_ = 0;  ///< J, of the constraint's part of the damping loss, last step
  bool holds_force_ = false;       ///< `force_` and `power_` are those at the state
  VelocitySolver solver_;
};

}  // namespace cloth
