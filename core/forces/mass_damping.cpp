// Damping of every motion in proportion to mass, F_i = -a m_i v_i: the same rate everywhere, whatever the
// grid.
#include "cloth/sums.h"
#include "forces/registry.h"

namespace cloth {
namespace {

class MassDamping : public Force {
 public:
  /// `rate` in 1/s; `system` must outlive the force.
  MassDamping(const ClothSystem& system, double rate) : mass_(&system.mass), rate_(rate) {}

  KernelCoverage join(SweepTerms& terms) const override {
    if (!terms.uniform_mass) return KernelCoverage::none;
    terms.damping = rate_ * terms.mass;
    return KernelCoverage::every_pass;
  }
  void add_damping(const Vec3Field&, const Vec3Field& velocity, Vec3Field& product) const override {
    const double rate = rate_;
    const double *v[] = {velocity.x(), velocity.y(), velocity.z()}, *const mass = mass_->data();
    double* p[] = {product.x(), product.y(), product.z()};
    for (int axis = 0; axis < 3; ++axis)
#pragma GCC ivdep
      for (std::size_t i = 0; i < velocity.size(); ++i) p[axis][i] += rate * mass[i] * v[axis][i];
  }
  bool add_node_damping(NodeDamping& damping) const override {
    damping.isotropic.per_mass += rate_;
    return true;
  }
  void add_power(const Vec3Field&, const Vec3Field& velocity, Work& power) const override {
    power.damping_loss += rate_ * ordered_sum(velocity.size(), [&](std::size_t i) {
                            return (*mass_)[i] * velocity[i].squaredNorm();
                          });
  }
  void add_linearisation(const ClothSystem&, const Vec3Field&, const LinearisationWeights& weights,
                         Linearisation& to) const override {
    for (std::size_t i = 0; i < to.nodes.size(); ++i) {
      const double diagonal = weights.velocity * rate_ * (*mass_)[i];
      to.nodes.add(i, {diagonal, 0, 0, diagonal, 0, diagonal});
    }
  }

 private:
  const std::vector<double>* mass_;
  double rate_;  ///< 1/s
};

}  // namespace

ForceEntry mass_damping_entry() {
  return {.make = [](const Scene& scene, const ClothSystem& system) -> std::unique_ptr<Force> {
            if (!scene.material || !(scene.material->mass_damping > 0)) return nullptr;
            return std::make_unique<MassDamping>(system, scene.material->mass_damping);
          },
          .work = &Work::damping_loss,
          .explain = [](const Scene& scene, const ClothSystem&) -> std::vector<StageInfo> {
            if (!scene.material) return {};
            return {coefficient_stage("mass damping", scene, "material.mass_damping")};
          }};
}

}  // namespace cloth
