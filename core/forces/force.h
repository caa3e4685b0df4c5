// Every force of the model is affine in the velocity:
//
//     f(x, v, t) = p(x, t) - D(x) v        p: position force, D: symmetric, positive semi-definite
//
// so a force is written once as p, D, its energy and its power, and an integrator may treat D v as it likes.
#pragma once

#include <optional>

#include "cloth/cloth_system.h"
#include "forces/hand.h"
#include "forces/linearisation.h"

namespace cloth {

struct Air;

/// Power of the non-conservative forces, or its integral: work. Signed into the cloth, except the loss. W or
/// J.
struct Work {
  double damping_loss = 0;  ///< taken by viscous and spring damping
  double air = 0;
  double brush = 0;
  double pull = 0;

  Work& operator+=(const Work& other) {
    damping_loss += other.damping_loss, air += other.air, brush += other.brush, pull += other.pull;
    return *this;
  }
  friend Work operator*(double scale, const Work& work) {
    return {scale * work.damping_loss, scale * work.air, scale * work.brush, scale * work.pull};
  }
};

/// The part of D that does not couple particles: isotropic * I + along_normal * n n^T, and one particle held
/// by hand; and the constants of what else methods bound or take apart.
struct NodeDamping {
  double isotropic = 0;     ///< N s/m
  double along_normal = 0;  ///< N s/m
  const Vec3Field* normal = nullptr;
  int held_particle = -1;
  double held_isotropic = 0;  ///< N s/m, in addition
  double held_stiffness = 0;  ///< N/m, of the spring to the hand
  double along_springs = 0;   ///< N s/m of every spring; the part of D that couples particles
};

/// What the passes of the kernels (kernels/spring_sweep.h) compute in one go with the springs' elasticity.
struct SweepTerms {
  bool uniform_mass = false;  ///< given: all particles have the same mass
  Vec3 gravity{0, 0, 0};      ///< m/s^2
  double damping = 0;         ///< N s/m, viscous
  double spring_damping = 0;  ///< N s/m, along every spring
  const Air* air = nullptr;
};

/// Which passes of the kernels compute a force: none, those of whole explicit steps, or evaluations as well.
enum class SweptIn { nothing, whole_steps, every_pass };

class Force {
 public:
  virtual ~Force() = default;

  /// Adds this force to what the kernels compute, and says in which passes they do; see SweepTerms.
  virtual SweptIn join(SweepTerms&) const { return SweptIn::nothing; }

  /// The wind brush, of which only the air takes notice.
  virtual void set_brush(const std::optional<BrushGust>&) {}

  /// Takes the positions and time that all calls below refer to until the next update, and adds p to `force`.
  /// Where those ask for `position`, it is the same once more: few forces keep it.
  virtual void update(const ClothSystem&, const Vec3Field& /*position*/, double /*time*/,
                      Vec3Field& /*force*/) {}

  /// Whether this force acts between the ends of springs: methods that treat springs as constraints leave it
  /// out.
  virtual bool is_internal() const { return false; }

  /// Whether this is the damping along springs, which the kernels compute apart from the rest of D.
  virtual bool is_damper_of_springs() const { return false; }

  /// product += D v
  virtual void add_damping(const Vec3Field& /*position*/, const Vec3Field& /*velocity*/,
                           Vec3Field& /*product*/) const {}

  /// Adds this force's part of D to `damping` and returns true, or returns false: D couples particles.
  virtual bool add_node_damping(NodeDamping&) const { return true; }

  /// Adds the power of this force at `velocity`, unless it is the derivative of an energy.
  virtual void add_power(const Vec3Field& /*position*/, const Vec3Field& /*velocity*/, Work&) const {}

  /// Adds this force's part of weight_velocity D + weight_position K, K the symmetric part of -dp/dx.
  virtual void add_linearisation(const ClothSystem&, const Vec3Field& /*position*/,
                                 const LinearisationWeights&, Linearisation& /*to*/) const {}

  /// The rest of -df/dx at `velocity`: product += (-df/dx - K) direction. Only where has_asymmetric_part().
  virtual bool has_asymmetric_part() const { return false; }
  virtual void add_asymmetric_product(const ClothSystem&, const Vec3Field& /*position*/,
                                      const Vec3Field& /*velocity*/, const Vec3Field& /*direction*/,
                                      Vec3Field& /*product*/) const {}
};

}  // namespace cloth
