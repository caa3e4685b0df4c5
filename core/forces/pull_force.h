// The hand that pulls a particle: a damped spring of rest length zero to the cursor's point, F = k (target -
// x) - c v. It is no entry of the registry: ForceModel::set_pull makes it and takes it away.
#pragma once

#include "forces/force.h"

namespace cloth {

class PullForce : public Force {
 public:
  PullForce(const Pull& pull, double stiffness, double damping)
      : pull_(pull), stiffness_(stiffness), damping_(damping) {}

  void update(const ClothSystem&, const Vec3Field& position, double, Vec3Field& force) override {
    spring_force_ = stiffness_ * (pull_.target - position[held()]);
    force.add(held(), spring_force_);
  }
  void add_damping(const Vec3Field&, const Vec3Field& velocity, Vec3Field& product) const override {
    product.add(held(), damping_ * velocity[held()]);
  }
  bool add_node_damping(NodeDamping& damping) const override {
    damping.held_particle = pull_.particle;
    damping.held_isotropic += damping_;
    damping.held_stiffness += stiffness_;
    return true;
  }
  void add_power(const Vec3Field&, const Vec3Field& velocity, Work& power) const override {
    const Vec3 v = velocity[held()];
    power.pull += (spring_force_ - damping_ * v).dot(v);
  }
  void add_linearisation(const ClothSystem&, const Vec3Field&, const LinearisationWeights& weights,
                         Linearisation& to) const override {
    const double diagonal = weights.position * stiffness_ + weights.velocity * damping_;
    to.nodes.add(held(), {diagonal, 0, 0, diagonal, 0, diagonal});
  }

 private:
  std::size_t held() const { return static_cast<std::size_t>(pull_.particle); }

  Pull pull_;
  double stiffness_;  ///< N/m
  double damping_;    ///< N s/m
  Vec3 spring_force_{0, 0, 0};
};

}  // namespace cloth
