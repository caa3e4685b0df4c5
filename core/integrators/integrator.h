// An integrator advances a state by one step of m a = f(x, v, t). It depends neither on which forces exist
// nor on the stages after it (limiter, contact). The simulation owns time.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "forces/force_model.h"

namespace cloth {

/// From t to t + h. The end is given, not added up, so that the last bit does not depend on the way there.
struct StepTimes {
  double begin = 0, end = 0, step = 0;  ///< s
};

/// Why a step could not be solved: bad numerics are data.
struct SolverFailure {
  int particle = 0;  ///< where the trouble is largest
  std::string cause;
};

struct IntegratorReport {
  int force_evaluations = 0;
  int velocity_iterations = 0;  ///< of the solve for centred damping
  int inner_steps = 1;          ///< accepted ones, of methods that divide the step
  int rejected_steps = 0;       ///< of error control
  int iterations = 0;           ///< of Newton's method, or local and global, or over all constraints
  int linear_iterations = 0;    ///< of conjugate gradients or another Krylov method
  int factorisations = 0;
  double residual =
      0;  ///< what the last iteration still changed: largest speed, relative to the largest of all
  std::optional<SolverFailure> failure = {};
  std::optional<double> speed_squares = {};  ///< sum of |v|^2 after the step in (m/s)^2, where it is known
};

/// What something other than the integrator has changed.
enum class Change { forces, state };

/// What a method carries from one step to the next beside the state, as far as later bits depend on it.
/// Caches and scratch are none of it. Only the method that made one can read it.
struct IntegratorMemory {
  std::vector<Vec3Field> fields;
  std::vector<double> numbers;
};

/// What the positions must obey whatever the forces say, as a method that kicks and then drifts asks for it.
/// It is no force of the model, but the tension that the last step needed may act as one in the next.
class DriftConstraint {
 public:
  virtual ~DriftConstraint() = default;
  /// Whether before_kick() would change the velocity.
  virtual bool holds() const = 0;
  /// When the forces are known: their kick of `kick` seconds and a drift of `drift` seconds follow. Adds its
  /// own kick. A step may have several kicks with a drift each.
  virtual void before_kick(double kick, double drift, ClothState& state) = 0;
  /// After the drift: moves positions to where they may be, changes the velocity, which led there, by
  /// displacement/drift, and adds its part of a closing kick of `closing_kick` seconds.
  virtual void after_drift(double closing_kick, ClothState& state) = 0;
  /// Adds that part to a velocity that is made anew from the drift's.
  virtual void close(ClothState& state) = 0;
  /// m/s, what the last step's opening kick and after_drift(), and its closing kick, have changed; null:
  /// nothing. The constraint's work is that of the one as if it came before all else, of the other as if it
  /// came last.
  virtual const Vec3Field* opening_change() const = 0;
  virtual const Vec3Field* closing_change() const = 0;
};

class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Advances position and velocity and adds the work of the forces to `work`, by a quadrature of the
  /// method's own order. Neither `state.time` nor `state.step` is touched.
  virtual IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state,
                                Work& work) = 0;

  /// Whether a batch of steps, whose states in between are not needed, now costs less than single steps.
  virtual bool gains_from_batches(const ForceModel&) const { return false; }
  /// A batch: as many steps of length `step` as there are `speed_squares`, to the same bits. Gives each
  /// step's speed_squares, and the report that each of them would give. Precondition: gains_from_batches().
  virtual IntegratorReport step_many(ForceModel&, double /*step*/, std::span<double> /*speed_squares*/,
                                     ClothState&, Work&) {
    return {};
  }

  /// Has every step keep `constraint`, null for none, which must outlive its use. False: this method has no
  /// drift between two kicks, and what is to hold must be made to hold after the step.
  virtual bool set_drift_constraint(DriftConstraint* /*constraint*/) { return false; }

  /// Whether a step goes from where it began with the velocity at its end, x' = x + h v'.
  virtual bool drifts_with_end_velocity() const { return false; }

  /// Something else has changed the forces, or the state too: what is remembered of them no longer holds.
  virtual void forget(Change) {}

  /// Whether the velocity at a step's end is made with the force where the step ends, so that it has to
  /// follow where contact has moved that.
  virtual bool velocity_follows_positions() const { return false; }

  /// Makes the velocity at the end of the last step anew, from `half_velocity`, in m/s, which led from its
  /// begin to where it ended without contact. Precondition: velocity_follows_positions().
  virtual void follow_positions(ForceModel&, const StepTimes&, const Vec3Field& /*half_velocity*/,
                                ClothState&) {}

  /// Makes it once more, with the damping of the velocities in the state, which contact has answered.
  /// Precondition: follow_positions() was the last call.
  virtual void follow_velocities(ForceModel&, const StepTimes&, const Vec3Field& /*half_velocity*/,
                                 ClothState&) {}

  /// The state at the end of the last step is another one by contact. Returns what that changes of the work
  /// which the step has added with the velocity that never happened.
  virtual Work follow_contact(ForceModel& forces, const StepTimes& times, const ClothState& state) {
    forget(Change::state);
    if (end_weight_ == 0 || !forces.has_power()) return {};
    forces.update(state.position, times.end);
    Work correction = end_weight_ * forces.power(state.position, state.velocity);
    correction += -end_weight_ * end_power_;
    return correction;
  }

  /// What `recall` needs to go on from the present state to the bit, perhaps in another object of the same
  /// choice. Most methods need nothing.
  virtual IntegratorMemory remember() const { return {}; }

  /// The state is again that at which `memory` was made; the forces stand elsewhere.
  virtual void recall(const IntegratorMemory&) { forget(Change::state); }

 protected:
  /// Of methods whose work takes the power at the end of the step: that power, and the time in s that it
  /// counts for.
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
