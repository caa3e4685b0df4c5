// The methods as the source report prints them. Not in the registry: they are wrong, and here to show it.
#pragma once

#include <optional>

#include "integrators/integrator.h"

namespace cloth {

/// Eq. (8) with its 3 k3: y' = y + h/6 (k1 + 2 k2 + 3 k3 + k4). The weights sum to 7/6: order 0.
class PrintedRk4 : public Integrator {
 public:
  IntegratorReport step(const ClothSystem& system, ForceModel& forces, const StepTimes& times,
                        ClothState& state, Work& work) override;

 private:
  Vec3Field force_, stage_position_, stage_velocity_, next_position_, next_velocity_;
};

/// Eq. (14), x(t+h) = 2 x(t) - x(t-h) + h^2 a(t), with the only velocity that it has, (x(t) - x(t-h))/h, in
/// a: that lags by half a step, and the order falls to 1 where a force depends on the velocity.
class PrintedVerlet : public Integrator {
 public:
  IntegratorReport step(const ClothSystem& system, ForceModel& forces, const StepTimes& times,
                        ClothState& state, Work& work) override;
  void forget(Change) override { previous_.reset(); }

 private:
  std::optional<Vec3Field> previous_;  ///< x(t-h), m
  Vec3Field force_, next_;
};

}  // namespace cloth
