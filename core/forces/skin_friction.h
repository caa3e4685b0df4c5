// Tangential drag of the air: F_i = c_t (I - n n^T) (u - v_i), with n the unit normal and u the wind at the
// particle (Stokes drag of a plate along its surface; Batchelor 1967). The air's drag along the normal is
// AirForce. The wind brush acts along the normal alone.
#pragma once

#include "forces/force.h"
#include "scene/scene.h"

namespace cloth {

class SkinFriction : public Force {
 public:
  /// air.skin_friction is c_t in N s/m, of every particle.
  explicit SkinFriction(const Air& air) : air_(air) {}

  void update(const ClothSystem& system, const Vec3Field& position, double time, Vec3Field& force) override;
  void add_damping(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const override;
  bool add_node_damping(NodeDamping& damping) const override;
  void add_power(const Vec3Field& position, const Vec3Field& velocity, Work& power) const override;
  void add_linearisation(const ClothSystem& system, const Vec3Field& position,
                         const LinearisationWeights& weights, Linearisation& to) const override;
  bool has_asymmetric_part() const override { return true; }
  void add_asymmetric_product(const ClothSystem& system, const Vec3Field& position, const Vec3Field& velocity,
                              const Vec3Field& direction, Vec3Field& product) const override;

 private:
  /// c_t times the part of `v` across the normal of particle i.
  Vec3 across(std::size_t i, const Vec3& v) const {
    return air_.skin_friction * (v - normal_[i].dot(v) * normal_[i]);
  }

  Air air_;
  Vec3 wind_{0, 0, 0};  ///< m/s, at the time of the last update
  Vec3Field normal_;
};

}  // namespace cloth
