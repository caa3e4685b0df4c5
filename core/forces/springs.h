// Springs, Eq. (1) of the report (Provot 1995): F_i = k (|d| - L) d/|d|, d = x_j - x_i; 0 where |d| = 0.
#pragma once

#include <array>

#include "forces/force.h"

namespace cloth {

class SpringForce : public Force {
 public:
  SweptIn join(SweepTerms&) const override { return SweptIn::every_pass; }
  void update(const ClothSystem& system, const Vec3Field& position, double time, Vec3Field& force) override;
  void add_linearisation(const ClothSystem& system, const Vec3Field& position,
                         const LinearisationWeights& weights, Linearisation& to) const override;
  bool is_internal() const override { return true; }
};

/// sum 1/2 k (|d| - L)^2 per family, in J, indexed by SpringFamily.
std::array<double, 3> elastic_energy(const ClothSystem& system, const Vec3Field& position);

/// Spring damping: F_i = k_d ((v_j - v_i) . d/|d|) d/|d| on every spring; 0 where |d| = 0.
class SpringDamping : public Force {
 public:
  /// `damping` in N s/m; `system` must outlive the force.
  SpringDamping(const ClothSystem& system, double damping) : system_(&system), damping_(damping) {}

  SweptIn join(SweepTerms& terms) const override {
    terms.spring_damping = damping_;
    return SweptIn::every_pass;
  }
  bool is_damper_of_springs() const override { return true; }
  void update(const ClothSystem& system, const Vec3Field& position, double time, Vec3Field& force) override;
  bool is_internal() const override { return true; }
  void add_damping(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const override;
  bool add_node_damping(NodeDamping& damping) const override;
  void add_power(const Vec3Field& position, const Vec3Field& velocity, Work& power) const override;
  void add_linearisation(const ClothSystem& system, const Vec3Field& position,
                         const LinearisationWeights& weights, Linearisation& to) const override;
  bool has_asymmetric_part() const override { return true; }
  void add_asymmetric_product(const ClothSystem& system, const Vec3Field& position, const Vec3Field& velocity,
                              const Vec3Field& direction, Vec3Field& product) const override;

 private:
  const ClothSystem* system_;
  double damping_;  ///< N s/m
};

}  // namespace cloth
