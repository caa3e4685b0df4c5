// The objective of an implicit Euler step (iterations.h), as its difference from that of another end of the
// step. Each element's difference is computed from the differences of both ends, so that what is left of
// convergence is seen far below the rounding of the objective itself.
#pragma once

#include "cloth/cloth_system.h"

namespace cloth {

class StepObjective {
 public:
  /// `inertia` (kg): M of each particle; `predicted` (m/s): (y - x)/h. The system must outlive it.
  StepObjective(const ClothSystem& system, double step, std::vector<double> inertia, Vec3Field start,
                Vec3Field predicted);

  /// G of the step that ends with `velocity` less G of that which ends with `other`, in J.
  double difference(const Vec3Field& velocity, const Vec3Field& other) const;

  const Vec3Field& predicted() const { return predicted_; }

 private:
  Vec3Field end_of(const Vec3Field& velocity) const;

  const ClothSystem* system_;
  double step_;
  std::vector<double> inertia_;
  Vec3Field start_, predicted_;
};

}  // namespace cloth
