// The forces that a scene has, as one sum f(x, v, t) = p(x, t) - D(x) v. What integrators see.
//
// Springs, their damping and the weight are summed by the kernels (kernels/spring_sweep.h) where those know
// the cloth; every other force is added through the interface of Force.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "forces/force.h"
#include "kernels/spring_sweep.h"

namespace cloth {

struct Scene;

class ForceModel {
 public:
  /// Only the forces that the scene has. `system` must outlive the model; after a change of its springs or
  /// masses call system_changed().
  ForceModel(const Scene& scene, const ClothSystem& system);
  void system_changed();

  const ClothSystem& system() const { return *system_; }

  /// One more force, which no scene file describes; it takes part like those of the scene.
  void add(std::unique_ptr<Force> force);

  /// One force evaluation: p, and whatever D needs, at (position, time). All other calls refer to it; where
  /// they ask for `position`, it is the same once more.
  void update(const Vec3Field& position, double time);

  /// The same without springs and their damping. Only position_force() and damping_parts() may follow.
  void update_external(const Vec3Field& position, double time);

  /// p of the last update, in N.
  const Vec3Field& position_force() const { return position_force_; }
  /// The same, for a step of the sweep that takes the positions on and leaves p where they end.
  Vec3Field& position_force_to_advance() { return position_force_; }

  /// What D and the pull consist of; the coefficients hold whatever the shape.
  NodeDamping damping_parts() const;
  /// Whether D couples particles, as dampers along springs do.
  bool couples_particles() const;
  /// product = the part of D v that couples particles, and the hand's. Returns v . product, in W.
  double coupled_damping(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const;

  /// p - D v, in N. Pinned particles have a force too; their inverse mass is 0.
  void force(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& result) const;

  /// The same, and its power().
  Work force_and_power(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& result) const;

  /// The power of everything that is not the derivative of an energy.
  Work power(const Vec3Field& position, const Vec3Field& velocity) const;

  bool has_damping() const { return has_damping_; }
  bool has_power() const { return has_power_; }
  /// Whether any power is booked as a loss by damping: more than air and hand.
  bool has_damping_loss() const { return has_damping_loss_; }

  /// A = M + weights.velocity D + weights.position K at the last update.
  void linearise(const Vec3Field& position, const LinearisationWeights& weights, Linearisation& result) const;

  /// product = (-df/dx - K) direction at `velocity`, the part of the exact Jacobian that K leaves out.
  bool has_asymmetric_part() const;
  void asymmetric_product(const Vec3Field& position, const Vec3Field& velocity, const Vec3Field& direction,
                          Vec3Field& product) const;

  /// The hand. A brush without air and a pull on a pinned particle have no effect.
  void set_brush(const std::optional<BrushGust>& brush);
  void set_pull(const std::optional<Pull>& pull, double stiffness, double damping);

  /// The kernels that know this cloth, null: none do.
  SpringSweep* sweep() const { return sweep_.get(); }
  /// What they compute of this scene; only where there are kernels.
  const SweepTerms& swept() const { return swept_; }
  /// N, of every particle, where the kernels compute it, else 0.
  Vec3 weight() const;
  /// Whether whole steps of the kernels compute every force of this model.
  bool is_swept_whole() const { return sweeps_steps() && !has_step_load(); }
  /// Whether the kernels can do whole steps of this cloth, and which forces would then have to be added as a
  /// load: p - D v, in N, at (position, time). Returns its power.
  bool sweeps_steps() const { return sweep_ && swept_.uniform_mass; }
  bool has_step_load() const { return pull_ || !apart_from_steps_.empty(); }
  Work step_load(const Vec3Field& position, const Vec3Field& velocity, double time, Vec3Field& load);

 private:
  void sort_forces();
  template <class Visit>  // visit(force): those of the scene in their order, then the pull
  void for_each_force(const Visit& visit) const {
    for (const auto& force : forces_) visit(*force);
    if (pull_) visit(*pull_);
  }
  bool sweeps_dampers() const { return sweep_ && swept_.spring_damping > 0; }
  bool is_damped_by_sweep(const Force& force) const {
    return sweeps_dampers() && force.is_damper_of_springs();
  }
  double swept_dampers(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const;
  double damping_product(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const;
  void add_power_beside_dampers(const Vec3Field& position, const Vec3Field& velocity, Work& power) const;

  const ClothSystem* system_;
  std::vector<std::unique_ptr<Force>> forces_;
  std::unique_ptr<Force> pull_;
  std::unique_ptr<SpringSweep> sweep_;
  SweepTerms swept_;
  std::vector<Force*> apart_;             ///< those of forces_ that evaluations of the sweep do not compute
  std::vector<Force*> apart_from_steps_;  ///< those that its whole steps do not compute
  Vec3Field position_force_;              ///< sized when first needed
  mutable Vec3Field product_;             ///< scratch, sized when first needed
  bool has_damping_ = false, has_power_ = false, has_damping_loss_ = false;
};

}  // namespace cloth
