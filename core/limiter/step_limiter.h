// The deformation rate as a stage of the step. Where a method has a drift between two kicks, the rate is kept
// between them (SHAKE: Ryckaert, Ciccotti, Berendsen 1977; RATTLE: Andersen 1983), so that the closing kick
// takes the forces of the limited shape. A kick by the forces of the overstretched one, which the limiter has
// already brought back, throws a taut spring back with restitution (omega h)^2/2: more than it came with,
// beyond 0.71 of the stable step. After other methods the rate is kept at the step's end.
#pragma once

#include "integrators/integrator.h"
#include "limiter/deformation_limiter.h"

namespace cloth {

class StepLimiter : public DriftConstraint {
 public:
  StepLimiter(const Deformation& deformation, const ClothSystem& system)
      : system_(&system), limiter_(deformation, system) {}

  /// Whether the pins are known to make the rate unreachable, from the next step on.
  void set_unreachable(bool unreachable) { limiter_.set_unreachable(unreachable); }

  /// A step of `time_step` seconds begins, by a method with or without drifts_with_end_velocity().
  void begin_step(double time_step, const ClothState& state, bool drifts_with_end_velocity);

  void before_kick(const ClothState& state) override;
  void after_drift(ClothState& state) override;

  /// For methods that do not call the constraint. Returns whether anything was moved.
  bool after_step(const Vec3& gravity, ClothState& state);

  /// Brings a start within the rate; no motion led there, so that none comes of it.
  void limit_start(double time_step, ClothState& state);

  const LimiterReport& report() const { return report_; }  ///< of the last step

  /// J, given to the cloth in the last step (negative: taken).
  double work() const { return work_; }

 private:
  void begin(double time_step);
  bool apply(ClothState& state);

  const ClothSystem* system_;
  DeformationLimiter limiter_;
  double time_step_ = 0;      ///< s
  bool drifts_with_end_velocity_ = false;
  Vec3Field start_velocity_;  ///< m/s, before the first kick
  LimiterReport report_;
  double work_ = 0;
};

}  // namespace cloth
