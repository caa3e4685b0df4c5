// Three implicit methods. Each step solves one nonlinear system (ImplicitStage).
#pragma once

#include "integrators/implicit/implicit_stage.h"

namespace cloth {

/// v' = v + h a(x', v', t'), x' = x + h v': order 1, damps every oscillation by omega h/2.
class ImplicitEuler : public Integrator {
 public:
  static constexpr double stage_weight = 1;  ///< ImplicitStage's weight divided by the step
  ImplicitEuler(double tolerance, int max_iterations) : stage_(tolerance, max_iterations) {}
  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  bool drifts_with_end_velocity() const override { return true; }

 private:
  ImplicitStage stage_;
  Vec3Field velocity_, position_;
};

/// v' = v + h a((x + x')/2, (v + v')/2, t + h/2): order 2, keeps the energy of linear oscillations.
class ImplicitMidpoint : public Integrator {
 public:
  static constexpr double stage_weight = 0.5;
  ImplicitMidpoint(double tolerance, int max_iterations) : stage_(tolerance, max_iterations) {}
  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  double last_stage_weight() const override { return stage_weight; }

 private:
  ImplicitStage stage_;
  Vec3Field velocity_, position_;
};

/// y' = 4/3 y(n) - 1/3 y(n-1) + 2/3 h f(y', t') for y = (x, v, work) (Curtiss and Hirschfelder 1952): order
/// 2, damps fast oscillations. The first step of a run is a midpoint step. A step after the limiter, contact
/// or an edit has changed the state is a step of implicit Euler, since the previous states then no longer
/// extrapolate.
class Bdf2 : public Integrator {
 public:
  static constexpr double stage_weight = 2.0 / 3;
  Bdf2(double tolerance, int max_iterations)
      : stage_(tolerance, max_iterations),
        midpoint_(tolerance, max_iterations),
        euler_(tolerance, max_iterations) {}
  IntegratorReport step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) override;
  /// After the limiter has acted, as a step of implicit Euler does.
  bool drifts_with_end_velocity() const override { return true; }
  double last_stage_weight() const override { return last_weight_; }
  void forget(Change change) override;
  IntegratorMemory remember() const override;
  void recall(const IntegratorMemory& memory) override;

 private:
  IntegratorReport multistep(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work);

  enum class History { none, broken, held };
  History history_ = History::none;
  ImplicitStage stage_;
  ImplicitMidpoint midpoint_;
  ImplicitEuler euler_;
  ClothState before_;                  ///< y(n-1), in use where the history is held
  double step_before_ = 0;             ///< s
  double last_weight_ = stage_weight;  ///< see last_stage_weight()
  Work work_before_;                   ///< J, of the last step
  Vec3Field known_position_, known_velocity_, velocity_, position_;
};

}  // namespace cloth
