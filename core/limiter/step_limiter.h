// The deformation rate as a stage of the step. With methods that drift, the rate is enforced at the end of
// the drift (SHAKE: Ryckaert et al. 1977; RATTLE: Andersen 1983), so that the closing kick takes the forces
// of the limited shape. With the forces of the overstretched shape a taut spring would rebound with
// restitution (omega h)^2/2, more than 1 beyond 0.71 of the stable step. The tensions of the last step act as
// forces in both kicks of the next one (warm start), so that only their changes are solved for and a taut
// cloth at rest has velocity 0. With other methods the rate is enforced at the end of the step, starting from
// tension 0.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "integrators/integrator.h"
#include "limiter/deformation_limiter.h"
#include "limiter/tension_solver.h"

namespace cloth {

class StepLimiter : public DriftConstraint {
 public:
  /// `unreachable`: the pins make the rate unreachable.
  StepLimiter(const Deformation& deformation, const ClothSystem& system, bool unreachable);

  /// A step of `time_step` seconds begins, by a method with or without drifts_with_end_velocity().
  void begin_step(double time_step, const ClothState& state, bool drifts_with_end_velocity);

  bool holds() const override;
  bool holds_few() const override;
  void before_kick(double kick, double drift, ClothState& state) override;
  void after_drift(double closing_kick, ClothState& state) override;
  void forget_tensions() override;
  void close(ClothState& state) override;
  const SparseField* opening_change() const override { return changed_ ? &change_ : nullptr; }
  const SparseField* closing_change() const override { return closed_ ? &closing_ : nullptr; }
  /// After the closing kick: adds its part to work().
  void end_step(const ClothState& state);

  /// For methods that do not call the constraint. Returns whether anything was moved.
  bool after_step(ClothState& state);

  /// After an after_step() that moved something, for methods that do not drift with their end velocity: keeps
  /// only as much of the change of velocity as does not increase the energy, where the move has added
  /// `potential` J to elastic and gravity energy.
  void limit_energy_gain(double potential, ClothState& state);

  /// Another stage has moved the cloth: updates the excess in report().
  void update_excess(const Vec3Field& position) { report_.excess = limiter_.excess(position); }

  /// Moves an initial shape to one that satisfies the rate, without changing velocities.
  void limit_initial_shape(double time_step, ClothState& state);

  const LimiterReport& report() const { return report_; }  ///< of the last step
  bool is_kept() const { return limiter_.accepts(report_.excess); }
  /// The ends of the spring that is furthest beyond the rate.
  std::pair<int, int> worst_spring(const Vec3Field& position) const;

  /// J, given to the cloth in the last step (negative: taken). Nothing where the limiter acted after a step
  /// of a method without drifts_with_end_velocity(): its work is then the change of the energy.
  std::optional<double> work() const { return work_; }

  /// N, with which the next step starts; part of a checkpoint.
  const std::vector<double>& tension() const { return tension_.values(); }
  void set_tension(const std::vector<double>& tension);

 private:
  void begin(double time_step);
  bool move(ClothState& state);
  double target_residual(const ClothState& state) const;
  void add_report(const LimiterReport& found);
  const SparseField& moved_from() const { return tensions_ ? tensions_->moved_from() : drifted_; }
  void find_change(const ClothState& state);
  void pull(double duration, const SpringTensions& tension, SparseField& change, ClothState& state);

  Deformation deformation_;
  const ClothSystem* system_;
  double mass_;  ///< kg, of the cloth
  DeformationLimiter limiter_;
  std::optional<TensionSolver> tensions_;  ///< none: solver "sweeps" or "direct"
  SpringTensions tension_;                 ///< N, at the end of the last step
  SpringTensions held_;                    ///< N, in the present step's latest kick

  // Of the present step.
  double time_step_ = 0;  ///< s, of the present drift
  bool drifts_with_end_velocity_ = false;
  double closing_kick_ = 0;       ///< s
  Vec3Field start_velocity_;      ///< m/s, before the first kick
  SparseField drifted_;           ///< m, without tensions_: before limiting
  SparseField change_, closing_;  ///< m/s, by opening kick and limiting; by the closing kick
  bool opened_ = false, changed_ = false, closed_ = false;
  SparseField pull_;  ///< N, scratch
  LimiterReport report_;
  std::optional<double> work_;
};

}  // namespace cloth
