// The hand that pulls a particle: a damped spring of rest length zero to the cursor's point, F = k (target -
// x) - c v.
#pragma once

#include "forces/force.h"

namespace cloth {

class PullForce : public Force {
 public:
  PullForce(const Pull& pull, double stiffness, double damping)
      : pull_(pull), stiffness_(stiffness), damping_(damping) {}

  void update(const ClothSystem& system, const Vec3Field& position, double time, Vec3Field& force) override;
  void add_damping(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const override;
  bool add_node_damping(NodeDamping& damping) const override;
  void add_power(const Vec3Field& position, const Vec3Field& velocity, Work& power) const override;
  void add_linearisation(const ClothSystem& system, const Vec3Field& position,
                         const LinearisationWeights& weights, Linearisation& to) const override;

 private:
  std::size_t held() const { return static_cast<std::size_t>(pull_.particle); }

  Pull pull_;
  double stiffness_;  ///< N/m
  double damping_;    ///< N s/m
  Vec3 spring_force_{0, 0, 0};
};

}  // namespace cloth
