// The work of damping in a step of velocity Verlet,
//
//     u = v + h/2 (p + d)/m,   x' = x + h u,   v' = u + h/2 (p' + d')/m,
//
// with p the force of the positions and d = - D v. A kick changes the kinetic energy by exactly its impulse
// times the mean of the velocities before and after. p does the work h/2 (p + p') . u, the trapezoid of its
// potential, and beside it h^2/8 (|p'|^2 - |p|^2)/m, which the next step begins to return. The rest of the
// kinetic energy is the work of damping:
//
//     h/2 (d + d') . u + h^2/8 (|p' + d'|^2 - |p'|^2 - |p + d|^2 + |p|^2)/m.
//
// For smooth motion that is the trapezoid of the powers, h/2 (d . v + d' . v'). Where contact stops particles
// and h D is many times m, those powers are many times the energy that there is.
#pragma once

#include "cloth/cloth_system.h"
#include "geometry/sparse_field.h"

namespace cloth {

/// What is known of a step, in the order in which it becomes known. Fields have one vector for each particle,
/// zero velocities for pinned ones.
class KickWork {
 public:
  /// The step has this length (s) and begins with the force p + d (N), whose damping is that at `velocity`.
  void open(double step, const Vec3Field& velocity, const Vec3Field& force, const Vec3Field& position_force);
  /// The same where the last step has ended so, close() with the same fields.
  void open_as_closed(double step);
  /// The positions move with u = `velocity` - `later` (m/s; null: 0). Precondition: is_known().
  void drift(const Vec3Field& velocity, const SparseField* later = nullptr);
  /// The step ends with the force p' + d', whose damping is that at `velocity`. Again where contact has
  /// changed it.
  void close(const Vec3Field& velocity, const Vec3Field& force, const Vec3Field& position_force);
  void forget() { is_known_ = is_closed_ = false; }

  bool is_known() const { return is_known_; }    ///< open() was called
  bool is_closed() const { return is_closed_; }  ///< close() too
  const Vec3Field& drift_velocity() const { return drift_; }
  const Vec3Field& end_velocity() const { return end_.velocity; }

  /// J: the work of damping less the trapezoid of its powers. Precondition: is_closed().
  double beside_trapezoid(const ClothSystem& system) const;
  /// The same where contact has then changed the state at the end of the step: from the position `integrated`
  /// and end_velocity() to `state`, where the force of the positions is `position_force`. Contact books an
  /// impulse that changes velocities at the mean of the velocities of the step, and one that balances other
  /// forces along the displacement (contact/contact_work.h); so does the damping that it balances.
  double beside_trapezoid(const ClothSystem& system, const Vec3Field& integrated, const ClothState& state,
                          const Vec3Field& position_force) const;

 private:
  /// At an end of the step.
  struct End {
    Vec3Field velocity, force, position_force;
  };
  double step_ = 0;
  End begin_, end_;
  Vec3Field drift_;
  bool is_known_ = false, is_closed_ = false;
};

}  // namespace cloth
