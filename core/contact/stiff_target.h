// Continuous contact after steps that are long compared with the springs' oscillations. To move particles to
// the positions that are nearest to the integrator's in the norm of the masses would stretch springs that
// have relaxed through obstacles within the step (as contact/stiff_contact.h says). Contact is then given the
// positions x of the step with contact instead of x*, where the method ended,
//
//     M (x - x*)/w^2 - (f(x, v) - f(x*, v*)) + r = sum of l a,    l >= 0, l = 0 where a . x > bound
//
// with v = v* + (x - x*)/w, with w, v* and r as in LongStep, and with a . x >= bound the constraints of near
// pairs; where the step has a deformation rate to keep, its tensions are loads too (contact/rate_tensions.h,
// contact/limited_contact.h for contact particle by particle). Newton's method with augmented Lagrangian
// penalties for the loads l (Hestenes 1969, Powell 1969). In its matrix the penalty of a constraint of
// several particles is bounded by one for each, so that it keeps its pattern.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "contact/contact_constraint.h"
#include "contact/long_step_solver.h"

namespace cloth {

class StiffTarget {
 public:
  /// The contacts at positions that an iteration has come to: those before, in their places, and new ones.
  using Renewal = std::function<std::span<const ContactConstraint>(const Vec3Field& position)>;

  /// m, of the contacts at the positions.
  static double largest_violation(std::span<const ContactConstraint> contacts, const Vec3Field& position);

  /// `position`: x* in, x out. Contacts of mobility 0 are none. Violations of up to `accepted` m count as
  /// none. Returns whether x* violates a constraint and x was found; else it stays. `renewed`: of contacts
  /// that turn with the positions; empty: they stay.
  bool solve(const ClothSystem& system, ForceModel& forces, std::span<const ContactConstraint> contacts,
             const LongStep& step, double accepted, Vec3Field& position, const Renewal& renewed = {});

  /// N, l of each contact of the last solve(), the renewed ones; 0 where it returned false.
  const std::vector<double>& loads() const { return load_; }

 private:
  double load_at(std::size_t contact, const Vec3Field& position) const;
  void add_penalties(const ClothSystem& system, double weight, const Vec3Field& position,
                     Linearisation& matrix);
  void find_push(const ClothSystem& system, ForceModel& forces, const LongStep& step,
                 const Vec3Field& position);
  bool find_direction(const ClothSystem& system, ForceModel& forces, const LongStep& step,
                      const Vec3Field& position);
  void move(const ClothSystem& system, ForceModel& forces, const LongStep& step, double before,
            Vec3Field& position);
  void update_loads(const Vec3Field& position);

  std::span<const ContactConstraint> contacts_;
  Vec3Field push_;  ///< N, what is left of the equation, 0 on pins
  Vec3Field integrated_position_, direction_, right_, start_;
  std::vector<double> load_, penalty_;  ///< N, N/m, of each contact
  std::vector<double> size_;            ///< kg, of each particle's block
  double resistance_ = 0;               ///< N/m, largest_resistance()
  LongStepSolver solver_;
};

}  // namespace cloth
