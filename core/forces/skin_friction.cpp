#include "forces/skin_friction.h"

#include "cloth/normals.h"
#include "cloth/sums.h"
#include "forces/air.h"

namespace cloth {

void SkinFriction::update(const ClothSystem& system, const Vec3Field& position, double time,
                          Vec3Field& force) {
  if (normal_.size() != position.size()) normal_ = Vec3Field(position.size());
  particle_normals(system, position, normal_);
  wind_ = wind_at(air_, time);
  if (wind_.squaredNorm() > 0)
    for (std::size_t i = 0; i < position.size(); ++i) force.add(i, across(i, wind_));
}

void SkinFriction::add_damping(const Vec3Field&, const Vec3Field& velocity, Vec3Field& product) const {
  for (std::size_t i = 0; i < velocity.size(); ++i) product.add(i, across(i, velocity[i]));
}

bool SkinFriction::add_node_damping(NodeDamping& damping) const {
  damping.isotropic += air_.skin_friction;
  damping.along_normal -= air_.skin_friction;
  damping.normal = &normal_;
  return true;
}

void SkinFriction::add_power(const Vec3Field&, const Vec3Field& velocity, Work& power) const {
  power.air += ordered_sum(velocity.size(),
                           [&](std::size_t i) { return across(i, wind_ - velocity[i]).dot(velocity[i]); });
}

void SkinFriction::add_linearisation(const ClothSystem&, const Vec3Field&,
                                     const LinearisationWeights& weights, Linearisation& to) const {
  const double c = weights.velocity * air_.skin_friction;
  for (std::size_t i = 0; i < to.nodes.size(); ++i) to.nodes.add(i, block_along(c, -c, normal_[i]));
}

/// F = c_t (w - (n . w) n) with w = u - v: the normal turns with the positions.
void SkinFriction::add_asymmetric_product(const ClothSystem& system, const Vec3Field& position,
                                          const Vec3Field& velocity, const Vec3Field& direction,
                                          Vec3Field& product) const {
  Vec3Field turned(position.size());
  particle_normal_changes(system, position, direction, turned);
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Vec3 n = normal_[i], dn = turned[i], w = wind_ - velocity[i];
    product.add(i, air_.skin_friction * (dn.dot(w) * n + n.dot(w) * dn));
  }
}

}  // namespace cloth
