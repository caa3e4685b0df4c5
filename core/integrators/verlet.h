// Velocity Verlet with the damping centred in time. Without velocity-dependent forces its positions are the
// report's Eq. (14), x(t+h) = 2 x(t) - x(t-h) + h^2 a(t).
//
//     v_half = v + h/2 a
//     x'     = x + h v_half
//     v'     = v_half + h/2 a'
//
// The accelerations hold every force of the scene, a(x, v, t) = (p - D v) / m (forces/force.h), wind as part
// of p. Four ways to take D v, of air drag as of viscous and spring damping (EndVelocity):
//
// solved:    a = a(x, v, t), a' = a(x', v', t+h). The last line is solved for v' (VelocitySolver, with
//            known = v_half and weight = h/2): closed where no damping couples particles, else by conjugate
//            gradients. Stable for omega h < 2 at every damping ratio. After contact has changed v' by c, the
//            next step begins with the damping at v_c, the solution with known = v_half + c, instead of that
//            at v' + c: of a difference of velocities that contact makes, h D/2m would be turned round, and
//            what touches would go that many times too far. The work of damping is that of the kicks
//            (KickWork), since the power of what contact has stopped is no mean of the step's.
// corrected: a' = a(x', v1, t+h) with v1 = v_half + h/2 a(x', v_half, t+h): two evaluations from the velocity
//            at half the step; the next step begins with a'. v1 is wrong by O(h^2), v' by O(h^3) a step:
//            order 2. For m x'' = -K x - D x' with any K and D, in units where m = 1 and h = 1, the velocity
//            u at half a step becomes u', with X = D/2 and
//                u' = u - A (K x' + D u),   A = 1 - X.
//            Hence N (u' - u) = -K x' - D (u + u')/2 with N = A^-1 - X. Times u + u', the energy u N u + x' K
//            x (x' = x + u) changes by - (u + u') D (u + u')/2: it never grows. It bounds the motion where K
//            < 4 N, and N >= 1 since A (1 + X) <= 1, for A > 0: a step with h D < 2 m is stable wherever an
//            undamped one is, whether K and D have common eigenvectors or not. Taken where h D <= m
//            (damping_load() of measure/stability_limit.h): beyond, 1 - 2 X A, what is left of a velocity
//            that no spring holds, rises again.
// corrected_twice: a' = a(x', v2, t+h) with v1 = v_half + h/4 a(x', v_half, t+h), v2 = v_half + h/2 a(x', v1,
//            t+h); v2 is wrong by O(h^2). The rest is the same with A = 1 - X + X^2/2, nearer to that of the
//            solution, (1 + X)^-1: A (1 + X) = 1 - X^2 (1 - X)/2, and 1 - 2 X A falls to 0 at h D = 2 m.
//            Taken where h D <= 1.95 m.
// predicted: a' = a(x', v + h a, t+h), at the velocity that the step predicts, and the next step begins with
//            that a'. No equation is solved. The prediction is wrong by O(h^2), v' by O(h^3) a step: order 2
//            (Groot and Warren 1997, with lambda = 1). On x'' = -omega^2 x - c x' the eigenvalues of a step
//            are the roots of z^3 + (w^2 + 3/2 g - 2) z^2 + (1 - 2 g) z + g/2, w = omega h, g = c h; by
//            Jury's test none exceeds 1 where w^2 + 4 g < 4. Each eigenvalue of m x'' = -K x - D x' is such a
//            root for the Rayleigh quotients of its own eigenvector, so that a step with h^2 K + 4 h D < 4 m
//            is stable, whether K and D have common eigenvectors or not. predicted_damping_load() of
//            measure/stability_limit.h bounds the left side for a scene.
//
// After continuous contact has moved the positions, the closing kick is that at the new ones
// (update_velocity_for_positions()), and is repeated with the damping at the velocities that contact has set
// (update_velocity_for_damping()).
//
// A constraint of the positions (DriftConstraint) acts between the drift and the closing kick, on x' and
// v_half; where the damping is predicted, on x' and the predicted velocity.
//
// Order 2 with damping, drag and wind. A step costs one force evaluation, and a second one where contact or
// an edit has changed the state since the last step; evaluations of the damping at the same positions are not
// counted.
#pragma once

#include "forces/velocity_solver.h"
#include "integrators/end_velocity.h"
#include "integrators/integrator.h"
#include "integrators/kick_work.h"

namespace cloth {

class Verlet : public Integrator {
 public:
  explicit Verlet(EndVelocity end = EndVelocity::solved) : end_(end) {}

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  bool waits_for_contact(const ForceModel& forces) const override;
  IntegratorReport open_step(ForceModel& forces, const StepTimes& times, ClothState& state,
                             Work& work) override;
  void close_step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work,
                  IntegratorReport& report) override;
  bool set_drift_constraint(DriftConstraint* constraint) override {
    constraint_ = constraint;
    return true;
  }
  bool velocity_follows_positions() const override { return true; }
  void update_velocity_for_damping(ForceModel& forces, const StepTimes& times, const Vec3Field& half_velocity,
                                   ClothState& state) override;
  int update_velocity_for_positions(ForceModel& forces, const StepTimes& times,
                                    const Vec3Field& half_velocity, ClothState& state) override;
  Work correct_work(ForceModel& forces, const StepTimes& times, const ClothState& state) override;
  void forget(Change) override {
    holds_position_force_ = holds_force_ = holds_damped_ = is_open_ = led_by_contact_ = false;
  }
  Vec3Field* held_force() override;
  /// The velocity at which damping was evaluated is not that of the state: what was computed with it is
  /// remembered.
  IntegratorMemory remember() const override;
  void recall(const IntegratorMemory& memory) override;

 protected:
  /// Computes the power and, where forces depend on the velocity, the force p - D v. The positions are those
  /// of the last ForceModel::update.
  virtual void evaluate(ForceModel& forces, const ClothState& state);
  /// Whether the next step begins with the force of the last evaluation: damping is not solved for.
  bool keeps_force(const ForceModel& forces) const;
  /// Takes from `work` what the damping that is known did at the opening, as far as the constraint had
  /// changed the velocity.
  void correct_opening(const ForceModel& forces, double half_step, Work& work) const;

  DriftConstraint* constraint_ = nullptr;
  Work power_;       ///< at the end of the last step
  Vec3Field force_;  ///< p - D v, N; used only where has_damping()
  Vec3Field scratch_;
  KickWork kicks_;                     ///< of the last step, where damping is solved for
  double closing_correction_ = 0;      ///< J, of the damping loss of the last step beside its powers
  bool holds_position_force_ = false;  ///< the force model was last updated at the state
  bool is_open_ = false;               ///< open_step() was the last call
  bool led_by_contact_ = false;  ///< the force model was last updated where contact has led the positions
  bool holds_force_ = false;     ///< `force_` and `power_` are those with which the next step begins

 private:
  void open_kicks(const ForceModel& forces, double step, bool as_closed, const ClothState& state);
  void close_kicks(const ForceModel& forces, const ClothState& state);
  Work correct_kicks(const ForceModel& forces, double half_step, bool was_open, bool was_led,
                     const ClothState& state);
  void damp_change(const ForceModel& forces, double half_step, const Vec3Field& unchanged,
                   const ClothState& state);
  double closing_correction(const ForceModel& forces, double step);
  const Vec3Field& force(const ForceModel& forces) const;
  int finish_velocity(ForceModel& forces, double half_step, double tolerance, ClothState& state);
  void finish_unsolved(ForceModel& forces, double half_step, ClothState& state);

  const EndVelocity end_;
  VelocitySolver solver_;
  // Where damping is solved for:
  Vec3Field integrated_;       ///< m, at the end of the step before contact has changed it
  Vec3Field free_velocity_;    ///< m/s, of update_velocity_for_positions()
  Work closing_power_;         ///< with which close_step() computed the work
  Vec3Field damped_;           ///< m/s, v_c
  bool holds_damped_ = false;  ///< `force_` and `power_` are those at `damped_`
};

/// The power in W of what `force` has beside `position_force`, - D v, where particles move by `change` (m/s).
double power_beside(const Vec3Field& position_force, const Vec3Field& force, const SparseField& change);

}  // namespace cloth
