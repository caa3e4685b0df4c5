// The bending of a material (cloth/bending.h): F = -K x, and its damping, F = -t K v with the damping time t.
// K is constant, so that -dp/dx = K and D = t K exactly.
#include <fmt/format.h>

#include "forces/registry.h"
#include "kernels/mesh_products.h"

namespace cloth {
namespace {

class Bending : public Force {
 public:
  KernelCoverage join(SweepTerms& terms) const override {
    return terms.has_shares ? KernelCoverage::every_pass : KernelCoverage::none;
  }
  bool is_internal() const override { return true; }
  void update(const ClothSystem& system, const Vec3Field& position, double, Vec3Field& force) override {
    add_bending_product(system, -1, position, force);
  }
  void add_linearisation(const ClothSystem&, const Vec3Field&, const LinearisationWeights& weights,
                         Linearisation& to) const override {
    to.bending += weights.position;
  }
};

class BendingDamping : public Force {
 public:
  /// `time` in s; `system` must outlive the force.
  BendingDamping(const ClothSystem& system, double time) : system_(&system), time_(time) {}

  KernelCoverage join(SweepTerms& terms) const override {
    if (!terms.has_shares) return KernelCoverage::none;
    terms.bending_time = time_;
    return KernelCoverage::every_pass;
  }
  bool is_swept_damper(const SweepTerms& terms) const override { return terms.bending_time > 0; }
  bool is_internal() const override { return true; }
  void add_damping(const Vec3Field&, const Vec3Field& velocity, Vec3Field& product) const override {
    add_bending_product(*system_, time_, velocity, product);
  }
  bool add_node_damping(NodeDamping& damping) const override {
    damping.bending_time += time_;
    return false;
  }
  void add_power(const Vec3Field&, const Vec3Field& velocity, Work& power) const override {
    power.damping_loss += time_ * bending_square(*system_, velocity);
  }
  void add_linearisation(const ClothSystem&, const Vec3Field&, const LinearisationWeights& weights,
                         Linearisation& to) const override {
    to.bending += weights.velocity * time_;
  }

 private:
  const ClothSystem* system_;
  double time_;  ///< s
};

std::vector<StageInfo> explain_bending(const Scene& scene, const ClothSystem& system) {
  if (!scene.material) return {};
  const Material& m = *scene.material;
  std::size_t count = 0;
  for (const BendingRun& run : system.bending) count += static_cast<std::size_t>(run.count);
  if (count == 0) return {{"bending", false, "material.bending_warp, bending_weft and twist are 0"}};
  return {{"bending", true,
           fmt::format("{} elements of {} N m along the warp, {} along the weft, twist {}", count,
                       m.bending_warp, m.bending_weft, m.twist)}};
}

std::vector<StageInfo> explain_bending_damping(const Scene& scene, const ClothSystem&) {
  if (!scene.material) return {};
  return {coefficient_stage("bending damping", scene, "material.bending_damping")};
}

}  // namespace

ForceEntry bending_entry() {
  return {.make = [](const Scene&, const ClothSystem& system) -> std::unique_ptr<Force> {
            return system.bending.empty() ? nullptr : std::make_unique<Bending>();
          },
          .explain = explain_bending};
}

ForceEntry bending_damping_entry() {
  return {.make = [](const Scene& scene, const ClothSystem& system) -> std::unique_ptr<Force> {
            if (system.bending.empty() || !scene.material || !(scene.material->bending_damping > 0))
              return nullptr;
            return std::make_unique<BendingDamping>(system, scene.material->bending_damping);
          },
          .work = &Work::damping_loss,
          .explain = explain_bending_damping};
}

}  // namespace cloth
