// The forces that a scene has, as one f(x, v, t) = p(x, t) - D(x) v. What integrators see.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "forces/force.h"
#include "forces/hand.h"
#include "kernels/step_sums.h"
#include "kernels/thread_choice.h"
#include "scene/scene.h"

namespace cloth {

struct SweepLoads;
struct SweptAir;
class AirForce;
class SpringDamping;
class SpringSweep;
class WorkerTeam;

class ForceModel {
 public:
  /// Only the forces that the scene has. `system` must outlive the model; after a change of its springs or
  /// masses call system_changed().
  ForceModel(const Scene& scene, const ClothSystem& system);
  void system_changed();
  ~ForceModel();
  ForceModel(ForceModel&&) noexcept;
  ForceModel& operator=(ForceModel&&) noexcept;

  /// One more force, which no scene file describes; it takes part like those of the scene.
  void add(std::unique_ptr<Force> force);

  /// One force evaluation: p, and whatever D needs, at (position, time). All other calls refer to it; where
  /// they ask for `position`, it is the same once more.
  void update(const Vec3Field& position, double time);

  /// The same without springs and their damping. Only position_force() and damping_parts() may follow.
  void update_external(const Vec3Field& position, double time);

  /// p of the last update, in N.
  const Vec3Field& position_force() const { return position_force_; }

  /// What D and the pull consist of; the coefficients hold whatever the shape.
  NodeDamping damping_parts() const;

  /// p - D v, in N. Pinned particles have a force too; their inverse mass is 0.
  void force(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& result) const;

  /// The same, and its power().
  Work force_and_power(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& result) const;

  /// The power of everything that is not the derivative of an energy.
  Work power(const Vec3Field& position, const Vec3Field& velocity) const;

  bool has_damping() const { return has_damping_; }
  bool has_power() const { return has_power_; }

  /// A = M + weights.velocity D + weights.position K at the last update.
  void linearise(const Vec3Field& position, const LinearisationWeights& weights, Linearisation& result) const;

  /// product = (-df/dx - K) direction at `velocity`, the part of the exact Jacobian that K leaves out.
  bool has_asymmetric_part() const;
  void asymmetric_product(const Vec3Field& position, const Vec3Field& velocity, const Vec3Field& direction,
                          Vec3Field& product) const;

  /// Solves (m + weight D) v = m known + weight p for the velocity of the free particles: the damping centred
  /// in time. `velocity` holds `known` and becomes v; pinned particles keep 0. `force` holds about p - D v,
  /// in N, from which the solution starts, and is scratch. Returns the iterations of conjugate gradients that
  /// were needed; 0 where D does not couple particles and the solution is closed.
  int centred_velocity(double weight, const Vec3Field& position, Vec3Field& velocity, Vec3Field& force);

  /// Whole steps, for a cloth whose particles have one mass and whose springs a sweep knows: force and motion
  /// in one pass. Each returns nothing, and has done nothing, where the scene needs more than that; else the
  /// sum of |v|^2 after the step. Nothing else may be asked until the next update, except after Verlet's,
  /// which leaves the model at the new positions.
  ///
  /// v' = v + h a(x, v, t), x' = x + h v', or with `drift_first` x + h v. Adds the work.
  std::optional<double> euler_step(double time, double step, bool drift_first, ClothState& state, Work& work);
  /// As many such steps as there are `squares`, to the bit; each of the squares becomes a step's sum of
  /// |v|^2. Precondition: gains_steps_at_once().
  void euler_steps(double step, bool drift_first, std::span<double> squares, ClothState& state, Work& work);
  void runge_kutta_steps(double step, std::span<double> squares, ClothState& state, Work& work);
  bool gains_steps_at_once() const;
  /// to = from, by the threads that step it.
  void copy(const ClothState& from, ClothState& to);
  /// From the last update, at the state's position, to the end of the step. `power` becomes that at the end.
  std::optional<double> verlet_step(double step, ClothState& state, Work& power);
  /// As many such steps as there are `squares`, without the states in between: the same bits. Each of the
  /// squares becomes a step's sum of |v|^2, of which power_after() makes its power. Precondition:
  /// steps_verlet(), that verlet_step would not return nothing.
  void verlet_steps(double step, std::span<double> squares, ClothState& state);
  bool steps_verlet() const { return can_step() && !has_load() && !spring_damping_; }
  Work power_after(double squares) const { return Work{.damping_loss = viscous_ * squares}; }
  /// Kutta's method of order four, whose evaluations of the force stand at `times`. Adds the work.
  std::optional<double> runge_kutta_step(const std::array<double, 4>& times, double step, ClothState& state,
                                         Work& work);

  /// Threads to share whole steps and evaluations among; null: one. Must outlive its use.
  void set_team(WorkerTeam* team, ThreadUse use = ThreadUse::where_they_gain);
  /// How many of them this cloth may use.
  int threads() const;

  /// The hand. A brush without air and a pull on a pinned particle have no effect.
  void set_brush(const std::optional<BrushGust>& brush);
  void set_pull(const std::optional<Pull>& pull, double stiffness, double damping);

  std::int64_t evaluations() const { return evaluations_; }

 private:
  void note_kinds();
  bool has_load() const { return pull_ || !beside_sweep_.empty(); }
  void update_load(const Vec3Field& position, double time);
  bool sweeps_air() const;
  bool steps_with_load() const { return has_load() && !sweeps_air(); }
  SweptAir swept_air(std::span<const double> times) const;
  void sweep_runge_kutta(const std::array<double, 4>& times, double step, std::span<double> squares,
                         ClothState& state, Work& work);
  bool can_step() const;
  bool sweeps_dampers() const { return sweep_ && spring_damping_; }
  SweepLoads sweep_loads(std::span<const double> times) const;
  bool is_swept(const Force& force) const;
  double swept_dampers(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const;
  double damping_product(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const;
  double coupled_product(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const;
  Work power_beside_dampers(const Vec3Field& position, const Vec3Field& velocity) const;
  void solve_per_node(double weight, const NodeDamping& damping, Vec3Field& velocity);
  int solve_coupled(double weight, const NodeDamping& local, const Vec3Field& position, Vec3Field& velocity,
                    Vec3Field& product);

  const ClothSystem* system_;
  std::vector<std::unique_ptr<Force>> forces_;
  AirForce* air_ = nullptr;  ///< the one of forces_ that feels the brush
  std::unique_ptr<Force> pull_;
  std::unique_ptr<SpringSweep> sweep_;  ///< computes springs and `weight_`, of a grid or a mesh
  std::vector<Force*> beside_sweep_;    ///< those of forces_ that the sweep does not compute
  Force *gravity_force_ = nullptr, *spring_force_ = nullptr, *viscous_force_ = nullptr;  ///< of forces_
  SpringDamping* spring_damping_ = nullptr;                                              ///< of forces_
  Vec3 gravity_{0, 0, 0};                                                                ///< m/s^2
  Vec3 weight_{0, 0, 0};  ///< N, of every particle, where the sweep takes care of gravity
  double viscous_ = 0;    ///< N s/m, of every particle
  WorkerTeam* team_ = nullptr;
  ThreadUse thread_use_ = ThreadUse::where_they_gain;
  std::vector<StageSums> stage_sums_;     ///< scratch
  Vec3Field position_force_;              ///< sized when first needed
  std::vector<double> inverse_diagonal_;  ///< 1/kg, scratch
  mutable Vec3Field product_;             ///< scratch, sized when first needed
  Vec3Field residual_, direction_;        ///< scratch, sized when first needed
  bool has_damping_ = false, has_power_ = false;
  std::int64_t evaluations_ = 0;
};

}  // namespace cloth
