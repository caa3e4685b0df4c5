#include "forces/pull_force.h"

namespace cloth {

void PullForce::update(const ClothSystem&, const Vec3Field& position, double, Vec3Field& force) {
  spring_force_ = stiffness_ * (pull_.target - position[held()]);
  force.add(held(), spring_force_);
}

void PullForce::add_damping(const Vec3Field&, const Vec3Field& velocity, Vec3Field& product) const {
  product.add(held(), damping_ * velocity[held()]);
}

bool PullForce::add_node_damping(NodeDamping& damping) const {
  damping.held_particle = pull_.particle;
  damping.held_isotropic += damping_;
  damping.held_stiffness += stiffness_;
  return true;
}

void PullForce::add_power(const Vec3Field&, const Vec3Field& velocity, Work& power) const {
  const Vec3 v = velocity[held()];
  power.pull += (spring_force_ - damping_ * v).dot(v);
}

void PullForce::add_linearisation(const ClothSystem&, const Vec3Field&, const LinearisationWeights& weights,
                                  Linearisation& to) const {
  const double diagonal = weights.position * stiffness_ + weights.velocity * damping_;
  to.nodes.add(held(), {diagonal, 0, 0, diagonal, 0, diagonal});
}

}  // namespace cloth
