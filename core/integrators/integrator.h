// An integrator advances a state by one step of m a = f(x, v, t). It does not depend on which forces exist,
// nor on the stages that follow it in a step (deformation limiter, contact; see simulation/simulation.h). The
// simulation counts time. integrators/registry.h lists the methods.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "forces/force_model.h"
#include "geometry/sparse_field.h"

namespace cloth {

/// From t to t + h. `end` is given rather than computed as begin + step, so that rounding errors do not add
/// up.
struct StepTimes {
  double begin = 0, end = 0, step = 0;  ///< s
};

/// Why the equations of a step could not be solved.
struct SolverFailure {
  int particle = 0;  ///< the one with the largest residual or error
  std::string cause;
};

struct IntegratorReport {
  int force_evaluations = 0;
  int velocity_iterations = 0;  ///< of VelocitySolver
  int inner_steps = 1;          ///< accepted inner steps, of methods that divide the step
  int rejected_steps = 0;       ///< inner steps rejected by error control
  int iterations =
      0;  ///< of Newton's method; of projective dynamics and VBD; passes of XPBD over the springs
  int linear_iterations = 0;  ///< of conjugate gradients, and steps of relaxation
  int factorisations = 0;     ///< of sparse matrices
  int held_normals = 0;       ///< equations solved with air along the normals of the step's beginning
  /// The largest change of a particle's speed by the last iteration, divided by the largest speed.
  double residual = 0;
  std::optional<SolverFailure> failure = {};
  std::optional<double> speed_squares = {};  ///< sum of |v|^2 after the step in (m/s)^2, each times its mass
                                             ///< over the largest, if computed anyway
};

/// What something other than the integrator has changed.
enum class Change { forces, state };

/// What a method keeps from one step to the next in addition to the state, where later results depend on it.
/// Caches and scratch memory do not belong to it. Only the method that made one can read it.
struct IntegratorMemory {
  std::vector<Vec3Field> fields;
  std::vector<double> numbers;
};

/// A constraint on the positions (the deformation limiter, limiter/step_limiter.h), enforced within the step
/// by methods that first update the velocity (kick) and then the position (drift). It is not a force of
/// ForceModel; the tensions that it needed in the last step act as a force in the next kick.
class DriftConstraint {
 public:
  virtual ~DriftConstraint() = default;
  /// Whether before_kick() would change the velocity.
  virtual bool holds() const = 0;
  /// Whether it would do so for few of the particles.
  virtual bool holds_few() const = 0;
  /// Called once the forces are known, before they act on the velocity for `kick` seconds and the position
  /// moves for `drift` seconds. Adds the constraint's own change of velocity. A step may have several such
  /// pairs.
  virtual void before_kick(double kick, double drift, ClothState& state) = 0;
  /// Called after the drift. Moves positions until they satisfy the constraint, changes the velocity by
  /// displacement / drift, and adds the constraint's part of the closing kick of `closing_kick` seconds.
  virtual void after_drift(double closing_kick, ClothState& state) = 0;
  /// Contact has moved what the constraint held: the next kick is without its tensions.
  virtual void forget_tensions() = 0;
  /// Adds that part again, to a velocity that is recomputed from that of the drift.
  virtual void close(ClothState& state) = 0;
  /// The changes of velocity in m/s in the last step: by before_kick() and after_drift(), and by the closing
  /// kick. Null: none. The work of the constraint is computed as if the opening change
  /// acted before all forces of the step and the closing change after them.
  virtual const SparseField* opening_change() const = 0;
  virtual const SparseField* closing_change() const = 0;
};

/// Contact of methods that divide a step into inner ones: it corrects the state at the end of each, so that
/// cloth is not moved back at once from where it got to within a long step (simulation/inner_contact.h).
class InnerStepContact {
 public:
  virtual ~InnerStepContact() = default;
  /// The state at the beginning of an inner step, before anything has changed it.
  virtual void begin(const ClothState& state) = 0;
  enum class Outcome { unchanged, changed, ended };
  /// The state at the end of that step. `ended`: the whole step ends there, and its state is not used but to
  /// say why.
  virtual Outcome correct(const StepTimes& inner, ClothState& state) = 0;
};

class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Advances position and velocity by one step and adds the work of the forces to `work`, by a quadrature of
  /// the order of the method. Does not change `state.time` and `state.step`.
  virtual IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                Work& work) = 0;

  /// Whether a step can wait for contact with its velocities: open_step() advances the positions,
  /// close_step() the velocities; one after the other they are step(). Where contact moves the positions in
  /// between, update_velocity_for_positions() takes the place of close_step().
  virtual bool waits_for_contact(const ForceModel&) const { return false; }
  virtual IntegratorReport open_step(ForceModel&, const StepTimes&, ClothState&, Work&) { return {}; }
  /// Adds to `report`, which is that of open_step().
  virtual void close_step(ForceModel&, const StepTimes&, ClothState&, Work&, IntegratorReport& /*report*/) {}

  /// Of methods that take a number of iterations instead of solving the equation of a step,
  /// M (v' - v)/h = f(x', v'): its left side less its right side at the end of the last step, in N, zero on
  /// pins. The caller asks before the next step begins. Null: the method solves the equation, or has none.
  virtual const Vec3Field* force_left(ForceModel&, const StepTimes&) { return nullptr; }

  /// Of methods that solve the equation of a step: its weight of the force in the last step divided by the
  /// step, which another kind of step may have than MethodFacts::stage_weight says.
  virtual double last_stage_weight() const { return 1; }

  /// Whether several steps in one call cost less than single steps, where the states in between are not
  /// needed.
  virtual bool gains_from_batches(const ForceModel&) const { return false; }
  /// Takes as many steps of length `step` (s) as there are `speed_squares`, with bitwise the same result as
  /// single steps. Fills in each step's sum of |v|^2 and returns the report of one step. Precondition:
  /// gains_from_batches().
  virtual IntegratorReport step_many(ForceModel&, double /*step*/, std::span<double> /*speed_squares*/,
                                     ClothState&, Work&) {
    return {};
  }

  /// Makes every step enforce `constraint`; null: none. It must outlive its use. Returns false where the
  /// method cannot enforce it within a step; the caller must then enforce it after each step.
  virtual bool set_drift_constraint(DriftConstraint* /*constraint*/) { return false; }

  /// Makes every inner step end with `contact`; null: none. It must outlive its use. Of methods with
  /// MethodFacts::has_inner_steps.
  virtual void set_inner_contact(InnerStepContact* /*contact*/) {}

  /// Whether the positions of a step are x' = x + h v' with the velocity v' at its end.
  virtual bool drifts_with_end_velocity() const { return false; }

  /// How the method goes through the elements of the cloth, with which its cost varies; for `explain`. Empty
  /// where that is said by the forces.
  virtual std::string visits_text(const ForceModel&) { return ""; }

  /// Tells the method that something else has changed the forces, or the state: values kept of them are
  /// invalid.
  virtual void forget(Change) {}

  /// Called as a step ends where a force depends on what has been (ForceModel::end_step()), so that forces
  /// change there: the force in N at the state with which the next step will begin, to be brought up to date.
  /// Null: the method keeps none, or no longer.
  virtual Vec3Field* held_force() {
    forget(Change::forces);
    return nullptr;
  }

  /// Whether the velocity at the end of a step is computed with the force at the end positions, so that it
  /// must be recomputed after contact has moved those.
  virtual bool velocity_follows_positions() const { return false; }

  /// Recomputes the velocity at the end of the last step for the positions in `state`. `half_velocity` in m/s
  /// is the displacement of the step divided by its length. Returns the iterations of VelocitySolver.
  /// Precondition: velocity_follows_positions().
  virtual int update_velocity_for_positions(ForceModel&, const StepTimes&, const Vec3Field& /*half_velocity*/,
                                            ClothState&) {
    return 0;
  }

  /// Recomputes that velocity with the damping forces at the velocities in `state`, which contact has
  /// changed. Precondition: update_velocity_for_positions() was the last call.
  virtual void update_velocity_for_damping(ForceModel&, const StepTimes&, const Vec3Field& /*half_velocity*/,
                                           ClothState&) {}

  /// Called after contact has changed the state at the end of the last step. step() computed its work with
  /// the velocities before contact; this returns the difference to be added. After open_step() alone, whose
  /// closing is not in the work yet, it returns that.
  virtual Work correct_work(ForceModel& forces, const StepTimes& times, const ClothState& state) {
    forget(Change::state);
    if (end_weight_ == 0 || !forces.has_power()) return {};
    forces.update(state.position, times.end);
    Work correction = end_weight_ * forces.power(state.position, state.velocity);
    correction += -end_weight_ * end_power_;
    return correction;
  }

  /// What `recall` needs to continue from the present state with bitwise the same results, also in another
  /// object made from the same IntegratorChoice. Most methods need nothing.
  virtual IntegratorMemory remember() const { return {}; }

  /// Continues from the state at which `memory` was made; the force model may have been updated elsewhere
  /// since.
  virtual void recall(const IntegratorMemory&) { forget(Change::state); }

 protected:
  /// Methods that compute work from the power at the end of the step store that power, and its weight in s.
  Work end_power_;
  double end_weight_ = 0;
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
