// Viscous damping, Eq. (2) of the report: F_i = -c v_i.
#pragma once

#include "forces/force.h"

namespace cloth {

class ViscousDamping : public Force {
 public:
  explicit ViscousDamping(double coefficient) : coefficient_(coefficient) {}

  SweptIn join(SweepTerms& terms) const override {
    terms.damping = coefficient_;
    return SweptIn::every_pass;
  }
  void update(const ClothSystem& system, const Vec3Field& position, double time, Vec3Field& force) override;
  void add_damping(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const override;
  bool add_node_damping(NodeDamping& damping) const override;
  void add_power(const Vec3Field& position, const Vec3Field& velocity, Work& power) const override;
  void add_linearisation(const ClothSystem& system, const Vec3Field& position,
                         const LinearisationWeights& weights, Linearisation& to) const override;

 private:
  double coefficient_;  ///< N s/m
};

}  // namespace cloth
