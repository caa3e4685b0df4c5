// The Runge-Kutta pair of orders 5 and 4 of Dormand and Prince (1980) for y = (x, v, work): the step goes on
// with the solution of order 5 (local extrapolation), the difference of the two is its error estimate, and
// the last stage of a step is the first of the next one. Work is no part of the estimate. With a tolerance,
// the method divides the step that it is given: step sizes by PI control (Gustafsson 1991), as in Hairer et
// al., I, II.4.
#pragma once

#include <array>
#include <limits>

#include "integrators/integrator.h"
#include "integrators/kick_impulse.h"

namespace cloth {

/// Chooses the sizes of inner steps from error estimates, given in units of the allowed error.
class StepSizeControl {
 public:
  /// The size of the next step in s; infinite before the first step.
  double size() const { return size_; }

  /// Call after a step of length `step` in s, perhaps shorter than size(), was accepted.
  void accept(double step, double error);
  /// Call after it was rejected. `error` may be infinite or NaN.
  void reject(double step, double error);
  void forget_history();

  /// The whole state as numbers, for IntegratorMemory, and back.
  std::vector<double> numbers() const { return {size_, last_error_, rejected_ ? 1.0 : 0.0}; }
  void recall(const std::vector<double>& numbers);

 private:
  double size_ = std::numeric_limits<double>::infinity();
  double last_error_ = 1;
  bool rejected_ = false;  ///< the last attempt
};

class DormandPrince : public Integrator {
 public:
  static constexpr int stage_count = 7;

  /// `tolerance`: largest displacement error of a step, in diagonals of the sheet. 0: no error control, and
  /// every step is one step of the method.
  explicit DormandPrince(double tolerance) : tolerance_(tolerance) {}

  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  void set_inner_contact(InnerStepContact* contact) override { contact_ = contact; }
  void forget(Change change) override;
  IntegratorMemory remember() const override;
  /// The slope is a function of state and time: the next step takes it again.
  void recall(const IntegratorMemory& memory) override;

 private:
  struct LargestError {
    double value = 0;  ///< in units of what is allowed
    int particle = 0;
  };

  void take_slope(ForceModel& forces, double time, const ClothState& state, IntegratorReport& report);
  void evaluate(ForceModel& forces, int stage, double time, IntegratorReport& report);
  void attempt(ForceModel& forces, const ClothState& from, const StepTimes& inner, IntegratorReport& report);
  Work work_of(const ForceModel& forces, double step, const ClothState& from, bool corrected);
  bool accept(ForceModel& forces, const StepTimes& inner, ClothState& state, Work& work,
              IntegratorReport& report);
  int first_without_slope() const;
  LargestError estimated_error(const ClothSystem& system, double step) const;
  void control(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work,
               IntegratorReport& report);

  double tolerance_;
  InnerStepContact* contact_ = nullptr;
  StepSizeControl control_;
  bool holds_slope_ = false;                         ///< the first stage is that of the present state
  bool has_touched_ = false;                         ///< contact has changed the end of the last inner step
  std::array<Vec3Field, stage_count> speed_;         ///< m/s, slope of the position at each stage
  std::array<Vec3Field, stage_count> acceleration_;  ///< m/s^2
  std::array<Work, stage_count> power_;              ///< W
  Vec3Field position_;                               ///< m, of the stage; after the last one the new one
  Vec3Field force_;                                  ///< N, scratch
  Vec3Field begin_position_force_;                   ///< N, p at the first stage
  Vec3Field position_forces_;                        ///< N, p of the others, weighted as in the solution
  KickImpulse kicks_;
};

}  // namespace cloth
