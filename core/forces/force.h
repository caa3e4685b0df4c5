// Every force of the model is affine in the velocity:
//
//     f(x, v, t) = p(x, t) - D(x) v        p: position force, D: symmetric, positive semi-definite
//
// so a force is written once as p, D, its energy and its power, and each integrator decides how it treats
// D v. Of the air's force (forces/air.h) the wind's part is in p, the resistance to the particle's own
// velocity in D. Verlet, for example, takes one half of D v at the begin of a step and the other, implicitly,
// at its end (integrators/verlet.h).
// Forces are made from a scene by forces/registry.h and summed by ForceModel (forces/force_model.h).
#pragma once

#include <algorithm>
#include <optional>

#include "cloth/cloth_system.h"
#include "forces/hand.h"
#include "forces/linearisation.h"
#include "kernels/thread_choice.h"

namespace cloth {

class WorkerTeam;

struct Air;
struct SliderGrid;

/// Power of the non-conservative forces in W, or its time integral, work, in J. Positive values add energy to
/// the cloth; losses are positive where energy is taken out.
struct Work {
  double damping_loss = 0;     ///< taken by viscous and spring damping
  double hysteresis_loss = 0;  ///< taken by friction in bending
  double air = 0;
  double brush = 0;
  double pull = 0;

  Work& operator+=(const Work& other) {
    damping_loss += other.damping_loss, hysteresis_loss += other.hysteresis_loss;
    air += other.air, brush += other.brush, pull += other.pull;
    return *this;
  }
  friend Work operator*(double scale, const Work& work) {
    return {scale * work.damping_loss, scale * work.hysteresis_loss, scale * work.air, scale * work.brush,
            scale * work.pull};
  }
};

/// A damping coefficient of every particle: the same for each, and a part in proportion to its mass.
struct NodeCoefficient {
  double each = 0;      ///< N s/m
  double per_mass = 0;  ///< 1/s
  double of(double mass) const { return each + per_mass * mass; }
  bool is_zero() const { return each == 0 && per_mass == 0; }
  NodeCoefficient scaled(double factor) const { return {factor * each, factor * per_mass}; }
  /// Without what is negative.
  NodeCoefficient positive() const { return {std::max(each, 0.0), std::max(per_mass, 0.0)}; }
  NodeCoefficient negative() const { return {std::min(each, 0.0), std::min(per_mass, 0.0)}; }
  bool operator==(const NodeCoefficient&) const = default;
};

/// The part of D that does not couple particles: the block isotropic * I + along_normal * n n^T of every
/// particle, and what the hand adds for the particle that it holds.
struct NodeDamping {
  NodeCoefficient isotropic, along_normal;
  const Vec3Field* normal = nullptr;
  int held_particle = -1;
  double held_isotropic = 0;  ///< N s/m, in addition
  double held_stiffness = 0;  ///< N/m, of the spring to the hand
  // The parts of D that couple particles: of every spring, per stiffness of it, and per K of bending
  // and of the membrane.
  double along_springs = 0;              ///< N s/m
  double stretch_time = 0;               ///< s
  double bending_time = 0;               ///< s
  double membrane_time = 0;              ///< s
  const SliderState* sliders = nullptr;  ///< of hysteresis, for methods that treat elements one by one
};

/// Coefficients of the forces that the kernels (kernels/spring_sweep.h) compute in the same pass as the
/// springs' elastic forces.
struct SweepTerms {
  bool uniform_mass = false;      ///< given: all particles have the same mass, or their share of `mass`
  bool has_shares = false;        ///< given: shares (GridSweep::has_shares()); bending is then computed too
  double mass = 0;                ///< kg, given: of every particle, or of one that has a whole share
  Vec3 gravity{0, 0, 0};          ///< m/s^2
  double damping = 0;             ///< N s/m, viscous
  double spring_damping = 0;      ///< N s/m, along every spring
  double stretch_time = 0;        ///< s, of dampers along springs
  double bending_time = 0;        ///< s, of dampers of bending
  bool takes_sliders = false;     ///< given: SpringSweep::takes_sliders()
  SliderGrid* sliders = nullptr;  ///< of hysteresis
  const Air* air = nullptr;
  double air_drag = 0, air_friction = 0;  ///< N s/m, along the normal and across it
  bool has_dampers() const { return spring_damping > 0 || stretch_time > 0 || bending_time > 0; }
};

/// Which passes of the kernels compute a force: none; those that do a whole explicit step; or also those that
/// only evaluate the force.
enum class KernelCoverage { none, whole_steps, every_pass };

class Force {
 public:
  virtual ~Force() = default;

  /// Adds this force to what the kernels compute, and says in which passes they do; see SweepTerms.
  virtual KernelCoverage join(SweepTerms&) const { return KernelCoverage::none; }

  /// Sets the wind brush, or removes it; only air drag uses it.
  virtual void set_brush(const std::optional<BrushGust>&) {}

  /// The threads that evaluations share their loops with; null: one thread.
  virtual void set_team(WorkerTeam*, ThreadUse) {}

  /// Whether this force acts along normals of the cloth, as air does.
  virtual bool has_normals() const { return false; }
  /// true: later updates keep the normals of the last one. false: each update finds its own.
  virtual void hold_normals(bool) {}

  /// Adds p at (position, time) to `force`, in N. All calls below refer to this position and time until the
  /// next update; where they take `position`, the caller passes the same field again, so that forces need no
  /// copy.
  virtual void update(const ClothSystem&, const Vec3Field& /*position*/, double /*time*/,
                      Vec3Field& /*force*/) {}

  /// Whether this force acts between the ends of springs. Methods that treat springs as constraints (XPBD)
  /// leave such forces out of the evaluation.
  virtual bool is_internal() const { return false; }

  /// Whether the kernels' pass for dampers (SpringSweep::damp()) computes this part of D, given what the
  /// forces have added to `terms`.
  virtual bool is_swept_damper(const SweepTerms& /*terms*/) const { return false; }

  /// product += D v, in N
  virtual void add_damping(const Vec3Field& /*position*/, const Vec3Field& /*velocity*/,
                           Vec3Field& /*product*/) const {}

  /// Adds this force's part of D to `damping` and returns true, or returns false: D couples particles.
  virtual bool add_node_damping(NodeDamping&) const { return true; }

  /// Adds the power of this force at `velocity`, in W. Conservative forces add nothing.
  virtual void add_power(const Vec3Field& /*position*/, const Vec3Field& /*velocity*/, Work&) const {}

  /// Adds this force's part of weight_velocity D + weight_position K, K the symmetric part of -dp/dx.
  virtual void add_linearisation(const ClothSystem&, const Vec3Field& /*position*/,
                                 const LinearisationWeights&, Linearisation& /*to*/) const {}

  /// A force that depends on what has been: the energy in J that it stores at `position`, what it loses of it
  /// as the step ends there, and what it remembers. As a step ends, `held` (N; null: none), a force at
  /// `position` that this one is part of, follows.
  virtual double stored_energy(const Vec3Field& /*position*/) const { return 0; }
  virtual double end_step(const Vec3Field& /*position*/, Vec3Field* /*held*/) { return 0; }
  virtual std::vector<double> history() const { return {}; }
  virtual void set_history(const std::vector<double>& /*history*/, const Vec3Field& /*position*/) {}

  /// The rest of -df/dx at `velocity`: product += (-df/dx - K) direction. Only where has_asymmetric_part().
  virtual bool has_asymmetric_part() const { return false; }
  virtual void add_asymmetric_product(const ClothSystem&, const Vec3Field& /*position*/,
                                      const Vec3Field& /*velocity*/, const Vec3Field& /*direction*/,
                                      Vec3Field& /*product*/) const {}
};

}  // namespace cloth
