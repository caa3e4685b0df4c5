// Drag of the air along the cloth, linear in the speed: F_i = c_t (I - n n^T) (u - v_i), with n the unit
// normal and u the wind at the particle. AirForce is the part along the normal. The wind brush acts along the
// normal alone.
#include "cloth/normals.h"
#include "cloth/sums.h"
#include "forces/air.h"
#include "forces/registry.h"

namespace cloth {
namespace {

class SkinFriction : public Force {
 public:
  /// `friction` is c_t of every particle; `system` must outlive the force.
  SkinFriction(const Air& air, const NodeCoefficient& friction, const ClothSystem& system)
      : air_(air), friction_(friction), mass_(&system.mass) {}

  KernelCoverage join(SweepTerms& terms) const override {
    if ((friction_.per_mass > 0) != terms.has_shares) return KernelCoverage::none;
    terms.air = &air_;
    terms.air_friction = friction_.of(terms.mass);
    return KernelCoverage::whole_steps;
  }
  bool has_normals() const override { return true; }
  void hold_normals(bool hold) override { holds_normals_ = hold; }
  void update(const ClothSystem& system, const Vec3Field& position, double time, Vec3Field& force) override {
    if (normal_.size() != position.size()) normal_ = Vec3Field(position.size());
    if (!holds_normals_) particle_normals(system, position, normal_);
    wind_ = wind_at(air_, time);
    if (wind_.squaredNorm() > 0)
      for (std::size_t i = 0; i < position.size(); ++i) force.add(i, across(i, wind_));
  }
  void add_damping(const Vec3Field&, const Vec3Field& velocity, Vec3Field& product) const override {
    for (std::size_t i = 0; i < velocity.size(); ++i) product.add(i, across(i, velocity[i]));
  }
  bool add_node_damping(NodeDamping& damping) const override {
    damping.isotropic.each += friction_.each, damping.isotropic.per_mass += friction_.per_mass;
    damping.along_normal.each -= friction_.each, damping.along_normal.per_mass -= friction_.per_mass;
    damping.normal = &normal_;
    return true;
  }
  void add_power(const Vec3Field&, const Vec3Field& velocity, Work& power) const override {
    power.air += ordered_sum(velocity.size(),
                             [&](std::size_t i) { return across(i, wind_ - velocity[i]).dot(velocity[i]); });
  }
  void add_linearisation(const ClothSystem&, const Vec3Field&, const LinearisationWeights& weights,
                         Linearisation& to) const override {
    for (std::size_t i = 0; i < to.nodes.size(); ++i) {
      const double c = weights.velocity * friction(i);
      to.nodes.add(i, block_along(c, -c, normal_[i]));
    }
  }
  bool has_asymmetric_part() const override { return !holds_normals_; }
  /// F = c_t (w - (n . w) n) with w = u - v: the normal turns with the positions.
  void add_asymmetric_product(const ClothSystem& system, const Vec3Field& position, const Vec3Field& velocity,
                              const Vec3Field& direction, Vec3Field& product) const override {
    if (turned_.size() != position.size()) turned_ = Vec3Field(position.size());
    particle_normal_changes(system, position, direction, turned_);
    for (std::size_t i = 0; i < position.size(); ++i) {
      const Vec3 n = normal_[i], dn = turned_[i], w = wind_ - velocity[i];
      product.add(i, friction(i) * (dn.dot(w) * n + n.dot(w) * dn));
    }
  }

 private:
  /// c_t times the part of `v` across the normal of particle i.
  Vec3 across(std::size_t i, const Vec3& v) const {
    return friction(i) * (v - normal_[i].dot(v) * normal_[i]);
  }

  double friction(std::size_t i) const { return friction_.of((*mass_)[i]); }

  Air air_;
  NodeCoefficient friction_;
  const std::vector<double>* mass_;
  Vec3 wind_{0, 0, 0};  ///< m/s, at the time of the last update
  Vec3Field normal_;
  bool holds_normals_ = false;
  mutable Vec3Field turned_;  ///< scratch
};

}  // namespace

ForceEntry skin_friction_entry() {
  return {.make = [](const Scene& scene, const ClothSystem& system) -> std::unique_ptr<Force> {
            const NodeCoefficient friction = drag_along_cloth(scene);
            if (friction.is_zero()) return nullptr;
            return std::make_unique<SkinFriction>(wind_of(scene), friction, system);
          },
          .work = &Work::air,
          .explain =
              [](const Scene& scene, const ClothSystem&) {
                return std::vector{coefficient_stage("skin friction", scene, cloth_drag_path(scene))};
              }};
}

}  // namespace cloth
