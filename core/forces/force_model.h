// The sum of a scene's forces, f(x, v, t) = p(x, t) - D(x) v: all that integrators know of forces.
//
// The kernels (kernels/spring_sweep.h) compute springs and gravity, and where a stepper does the whole step,
// damping and drag too (SweepTerms), for the cloths that they support; every other force is added through the
// interface of Force.
//
//     forces.update(position, time);               // one force evaluation: p, and what D needs
//     forces.force(position, velocity, force);     // p - D v, in N
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "forces/force.h"
#include "kernels/shared_job.h"
#include "kernels/spring_sweep.h"

namespace cloth {

struct Scene;

class ForceModel {
 public:
  /// Makes the forces that the scene has. `system` must outlive the model; call system_changed() after a
  /// change of its springs or masses.
  ForceModel(const Scene& scene, const ClothSystem& system);
  void system_changed();

  const ClothSystem& system() const { return *system_; }

  /// Adds a force that no scene file describes; it is treated like those of the scene.
  void add(std::unique_ptr<Force> force);

  /// One force evaluation: computes p, and what D needs, at (position, time). All other calls refer to it;
  /// where they take `position`, pass the same field again.
  void update(const Vec3Field& position, double time);

  /// The same without springs and their damping. Only position_force() and damping_parts() may follow.
  void update_external(const Vec3Field& position, double time);

  /// p of the last update, in N.
  const Vec3Field& position_force() const { return position_force_; }
  /// The same, for kernels that advance the positions and leave p at the new ones.
  Vec3Field& position_force_to_advance() { return position_force_; }

  /// The coefficients of D and of the pull; they do not depend on the shape of the cloth.
  NodeDamping damping_parts() const;
  /// Whether D couples particles, as dampers along springs do.
  bool couples_particles() const;
  /// product = D v, in N, of the forces that couple particles and of the hand. Returns v . product, in W.
  double coupled_damping(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const;

  /// p - D v, in N. Pinned particles have a force too; their inverse mass is 0.
  void force(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& result) const;

  /// Computes the same force and returns power().
  Work force_and_power(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& result) const;

  /// The power of all non-conservative forces.
  Work power(const Vec3Field& position, const Vec3Field& velocity) const;

  bool has_damping() const { return has_damping_; }
  bool has_power() const { return has_power_; }
  /// Whether a force of the scene adds to Work::damping_loss (viscous damping, damping along springs).
  bool has_damping_loss() const { return has_damping_loss_; }

  /// Of the force that depends on what has been (Force::stored_energy); whether there is one. At most one.
  bool has_history() const { return with_history_ != nullptr; }
  double stored_energy(const Vec3Field& position) const;
  /// Ends a step at `position`: returns what that force has lost, in J. `held` (N; null: none) is the force
  /// at `position` with which a method will begin its next step; it becomes what it then is.
  double end_step(const Vec3Field& position, Vec3Field* held = nullptr);
  std::vector<double> history() const {
    return with_history_ ? with_history_->history() : std::vector<double>();
  }
  void set_history(const std::vector<double>& history, const Vec3Field& position);

  /// A = M + weights.velocity D + weights.position K at the last update.
  void linearise(const Vec3Field& position, const LinearisationWeights& weights, Linearisation& result) const;

  /// product = (-df/dx - K) direction at `velocity`, the part of the exact Jacobian that K leaves out.
  bool has_asymmetric_part() const;
  void asymmetric_product(const Vec3Field& position, const Vec3Field& velocity, const Vec3Field& direction,
                          Vec3Field& product) const;

  /// Of the forces that act along normals of the cloth (Force::hold_normals).
  bool has_normals() const;
  void hold_normals(bool hold);

  /// Sets or removes the wind brush and the pull (forces/hand.h). A brush without air drag and a pull on a
  /// pinned particle have no effect. `stiffness` in N/m, `damping` in N s/m.
  void set_brush(const std::optional<BrushGust>& brush);
  void set_pull(const std::optional<Pull>& pull, double stiffness, double damping);

  /// The threads that evaluations, beside those of the kernels, and solves for velocities share their loops
  /// with. Results do not depend on them.
  void set_team(WorkerTeam* team, ThreadUse use);
  SharedJob& solve_job() const { return solve_job_; }  ///< of a solve, see shared_job.h

  /// The kernels for this cloth; null where no kernel supports it.
  SpringSweep* sweep() const { return sweep_.get(); }
  /// The terms of this scene that those kernels compute. Precondition: sweep().
  const SweepTerms& swept() const { return swept_; }
  /// The weight of every particle in N where the kernels compute gravity; else 0.
  Vec3 weight() const;
  /// Whether the kernels' whole steps include every force of this model.
  bool is_swept_whole() const { return sweeps_steps() && !has_step_load(); }
  /// Whether the kernels can do whole steps of this cloth; whether forces remain that they do not compute;
  /// and the sum of those, p - D v in N at (position, time), which such a step takes as a load. Returns its
  /// power.
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
  bool sweeps_dampers() const { return sweep_ && swept_.has_dampers(); }
  bool is_damped_by_sweep(const Force& force) const { return sweep_ && force.is_swept_damper(swept_); }
  double swept_dampers(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const;
  double damping_product(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const;
  void add_power_beside_dampers(const Vec3Field& position, const Vec3Field& velocity, Work& power) const;

  const ClothSystem* system_;
  std::vector<std::unique_ptr<Force>> forces_;
  std::unique_ptr<Force> pull_;
  Force* with_history_ = nullptr;
  std::unique_ptr<SpringSweep> sweep_;
  SweepTerms swept_;
  std::vector<Force*> apart_;             ///< forces that the kernels' evaluations do not include
  std::vector<Force*> apart_from_steps_;  ///< forces that the kernels' whole steps do not include
  Vec3Field position_force_;              ///< sized when first needed
  mutable SharedJob solve_job_;
  mutable Vec3Field product_;  ///< scratch, sized when first needed
  bool has_damping_ = false, has_power_ = false, has_damping_loss_ = false;
};

}  // namespace cloth
