// The deformation rate as a constraint of a long step's equation (contact/long_step_solver.h): tensions t of
// the limited springs,
//
//     t >= 0,    t = 0 where |d| < (1 + rate) L
//
// that pull both ends together. Shortening the springs afterwards, in the norm of the masses
// (limiter/deformation_limiter.h), would compress others that are stiff for the step, and contact would
// stretch them again: in both the cloth gains energy. The positions within the rate form a convex set, as
// those outside of planes do, so that a step of implicit Euler with both as constraints gains none.
//
// By augmented Lagrangian penalties (Hestenes 1969, Powell 1969): t(x) = max(0, t + p (|d| - (1 + rate) L)),
// with p a few times what else resists, the spring's own stiffness and the inertia of its ends. With much
// larger ones Newton's method takes short steps, since springs that turn become longer.
#pragma once

#include <vector>

#include "forces/linearisation.h"
#include "scene/scene.h"

namespace cloth {

class RateTensions {
 public:
  RateTensions(const Deformation& deformation, const ClothSystem& system);

  /// A step whose weight is w (s) begins, with tensions of 0.
  void begin(double weight);

  /// Whether every limited spring is within the rate and its tolerance.
  bool keeps(const Vec3Field& position) const;

  /// Adds the forces of t(x), in N.
  void add_force(const Vec3Field& position, Vec3Field& force) const;

  /// Adds w^2 times the derivatives of those forces to the springs' blocks.
  void add_stiffness(const Vec3Field& position, Linearisation& matrix) const;

  /// t becomes t(x).
  void update(const Vec3Field& position);

  /// W, of the forces of t.
  double power(const Vec3Field& position, const Vec3Field& velocity) const;

 private:
  struct Limited {
    std::size_t first = 0, second = 0;  ///< particles
    std::size_t spring = 0;             ///< its number in ClothSystem::springs
    double longest = 0, accepted = 0;   ///< m, without and with the tolerance
    double resistance = 0;              ///< N/m, its own, or the membrane's where springs have none
    double mass = 0;                    ///< kg, of the heavier end
    double penalty = 0;                 ///< N/m, p
  };
  Vec3 difference(const Limited& spring, const Vec3Field& of) const {
    return of[spring.second] - of[spring.first];
  }
  double tension_at(std::size_t s, double length) const;
  template <class Visit>
  void for_each_taut(const Vec3Field& position, Visit visit) const;

  std::vector<Limited> springs_;
  std::vector<double> tension_;  ///< N, t
  double weight_ = 0;            ///< s, w
};

}  // namespace cloth
