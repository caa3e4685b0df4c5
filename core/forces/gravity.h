// Gravity, Eq. (3) of the report: F_i = m g.
#pragma once

#include "forces/force.h"

namespace cloth {

class Gravity : public Force {
 public:
  explicit Gravity(const Vec3& acceleration) : acceleration_(acceleration) {}

  SweptIn join(SweepTerms& terms) const override {
    if (!terms.uniform_mass) return SweptIn::nothing;
    terms.gravity = acceleration_;
    return SweptIn::every_pass;
  }
  void update(const ClothSystem& system, const Vec3Field& position, double time, Vec3Field& force) override;

 private:
  Vec3 acceleration_;  ///< m/s^2
};

/// -sum m g . (x - x(0)), in J.
double gravity_energy(const ClothSystem& system, const Vec3& acceleration, const Vec3Field& position);

}  // namespace cloth
