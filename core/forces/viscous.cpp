// Viscous damping, Eq. (2) of the report: F_i = -c v_i.
#include "cloth/sums.h"
#include "forces/registry.h"

namespace cloth {
namespace {

class ViscousDamping : public Force {
 public:
  explicit ViscousDamping(double coefficient) : coefficient_(coefficient) {}

  KernelCoverage join(SweepTerms& terms) const override {
    if (terms.has_shares) return KernelCoverage::none;
    terms.damping = coefficient_;
    return KernelCoverage::every_pass;
  }
  void add_damping(const Vec3Field&, const Vec3Field& velocity, Vec3Field& product) const override {
    const auto v = velocity.flat();
    const auto out = product.flat();
    for (std::size_t k = 0; k < v.size(); ++k) out[k] += coefficient_ * v[k];
  }
  bool add_node_damping(NodeDamping& damping) const override {
    damping.isotropic.each += coefficient_;
    return true;
  }
  void add_power(const Vec3Field&, const Vec3Field& velocity, Work& power) const override {
    power.damping_loss += coefficient_ * dot(velocity.flat(), velocity.flat());
  }
  void add_linearisation(const ClothSystem&, const Vec3Field&, const LinearisationWeights& weights,
                         Linearisation& to) const override {
    const double diagonal = weights.velocity * coefficient_;
    for (std::size_t i = 0; i < to.nodes.size(); ++i)
      to.nodes.add(i, {diagonal, 0, 0, diagonal, 0, diagonal});
  }

 private:
  double coefficient_;  ///< N s/m
};

}  // namespace

ForceEntry viscous_damping_entry() {
  return {.make = [](const Scene& scene, const ClothSystem&) -> std::unique_ptr<Force> {
            if (!(scene.damping.value_or(0) > 0)) return nullptr;
            return std::make_unique<ViscousDamping>(*scene.damping);
          },
          .work = &Work::damping_loss,
          .explain = [](const Scene& scene, const ClothSystem&) -> std::vector<StageInfo> {
            if (scene.material) return {};  // mass_damping.cpp
            return {coefficient_stage("viscous damping", scene, "damping")};
          }};
}

}  // namespace cloth
