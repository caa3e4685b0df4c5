// The deformation rate as a stage of the step. Where a method has a drift, the rate is kept at its end
// (SHAKE: Ryckaert, Ciccotti, Berendsen 1977; RATTLE: Andersen 1983), so that a closing kick takes the forces
// of the limited shape. A kick by the forces of the overstretched one, which the limiter has already brought
// back, throws a taut spring back with restitution (omega h)^2/2: more than it came with, beyond 0.71 of the
// stable step. Tensions that the last step has found act as forces in the kicks of the next one, opening and
// closing alike, so that only their changes are left to find and a taut cloth at rest has no speed. After
// other methods the rate is kept at the step's end, from no tension.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "integrators/integrator.h"
#include "limiter/deformation_limiter.h"
#include "limiter/tension_solver.h"

namespace cloth {

class StepLimiter : public DriftConstraint {
 public:
  StepLimiter(const Deformation& deformation, const ClothSystem& system);

  /// Whether the pins are known to make the rate unreachable, from the next step on.
  void set_unreachable(bool unreachable);

  /// A step of `time_step` seconds begins, by a method with or without drifts_with_end_velocity().
  void begin_step(double time_step, const ClothState& state, bool drifts_with_end_velocity);

  bool holds() const override;
  void before_kick(double kick, double drift, ClothState& state) override;
  void after_drift(double closing_kick, ClothState& state) override;
  void close(ClothState& state) override;
  const Vec3Field* opening_change() const override { return changed_ ? &change_ : nullptr; }
  const Vec3Field* closing_change() const override { return closed_ ? &closing_ : nullptr; }
  /// After the closing kick: adds its part to work().
  void end_step(const ClothState& state);

  /// For methods that do not call the constraint. Returns whether anything was moved.
  bool after_step(ClothState& state);

  /// After a call of it that moved something, by a method that does not go with its end velocity: as much of
  /// the change of velocity as does not add to the energy, where the move has added `potential` J to elastic
  /// and potential energy.
  void restrain(double potential, ClothState& state);

  /// Something else has moved the cloth since: report() tells the excess of these positions.
  void look_again(const Vec3Field& position) { report_.excess = limiter_.excess(position); }

  /// Brings a start within the rate; no motion led there, so that none comes of it.
  void limit_start(double time_step, ClothState& state);

  const LimiterReport& report() const { return report_; }  ///< of the last step
  bool is_kept() const { return limiter_.accepts(report_.excess); }
  /// The ends of the spring that is furthest beyond the rate.
  std::pair<int, int> worst_spring(const Vec3Field& position) const;

  /// J, given to the cloth in the last step (negative: taken). Nothing where a method without a drift of its
  /// own was moved after the step and goes with another velocity than drifts_with_end_velocity() says: that
  /// is the energy after it less that before.
  std::optional<double> work() const { return work_; }

  /// N, what the next step will hold: to be remembered with a state.
  const std::vector<double>& tension() const { return tension_; }
  void set_tension(const std::vector<double>& tension);

 private:
  void begin(double time_step);
  bool move(ClothState& state);
  double aim(const ClothState& state) const;
  void add_report(const LimiterReport& found);
  void add_speed_of_move(ClothState& state) const;
  void pull(double duration, const std::vector<double>& tension, ClothState& state);

  Deformation deformation_;
  const ClothSystem* system_;
  DeformationLimiter limiter_;
  std::optional<TensionSolver> tensions_;  ///< none: the limiter's sweeps or its nearest shape
  std::vector<double> tension_;            ///< N, at the end of the last step
  std::vector<double> held_;               ///< N, in the present step's opening kick
  bool holds_ = false;                     ///< any of tension_ is above 0

  // Of the present step.
  double time_step_ = 0;  ///< s, of the present drift
  bool drifts_with_end_velocity_ = false;
  double closing_kick_ = 0;     ///< s
  Vec3Field start_velocity_;    ///< m/s, before the first kick
  Vec3Field drifted_;           ///< m
  Vec3Field change_, closing_;  ///< m/s, by opening kick and limiting; by the closing kick
  bool opened_ = false, changed_ = false, closed_ = false;
  Vec3Field pull_;  ///< N, scratch
  LimiterReport report_;
  std::optional<double> work_;
};

}  // namespace cloth
