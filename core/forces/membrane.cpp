// The stretching and shearing of a material on a mesh (cloth/membrane.h): F = -dE/dx, and its damping, F = -t
// J^T K J v with the damping time t.
#include "cloth/membrane.h"

#include <fmt/format.h>

#include "forces/registry.h"
#include "kernels/mesh_products.h"

namespace cloth {
namespace {

class MembraneForce : public Force {
 public:
  bool is_internal() const override { return true; }
  void update(const ClothSystem& system, const Vec3Field& position, double, Vec3Field& force) override {
    add_membrane_force(system.membrane, position, force);
  }
  /// J^T K J, and of every edge its tension in every direction. A sum of edges that all pull is never
  /// negative: clamping leaves those out that push.
  void add_linearisation(const ClothSystem& system, const Vec3Field& position,
                         const LinearisationWeights& weights, Linearisation& to) const override {
    to.add_membrane(position, weights.position);
    for_each_edge_tension(system.membrane, position, [&](std::size_t spring, double tension) {
      if (tension < 0) {
        to.has_compressed = true;
        if (weights.clamped) return;
      }
      const double k = weights.position * tension;
      to.springs.add(spring, {k, 0, 0, k, 0, k});
    });
  }
};

class MembraneDamping : public Force {
 public:
  /// `time` in s; `system` must outlive the force.
  MembraneDamping(const ClothSystem& system, double time) : membrane_(&system.membrane), time_(time) {}

  bool is_internal() const override { return true; }
  void add_damping(const Vec3Field& position, const Vec3Field& velocity, Vec3Field& product) const override {
    add_membrane_product(*membrane_, time_, position, velocity, product);
  }
  bool add_node_damping(NodeDamping& damping) const override {
    damping.membrane_time += time_;
    return false;
  }
  void add_power(const Vec3Field& position, const Vec3Field& velocity, Work& power) const override {
    power.damping_loss += time_ * membrane_square(*membrane_, position, velocity);
  }
  void add_linearisation(const ClothSystem&, const Vec3Field& position, const LinearisationWeights& weights,
                         Linearisation& to) const override {
    to.add_membrane(position, weights.velocity * time_);
  }
  bool has_asymmetric_part() const override { return true; }
  void add_asymmetric_product(const ClothSystem&, const Vec3Field& position, const Vec3Field& velocity,
                              const Vec3Field& direction, Vec3Field& product) const override {
    add_membrane_turning(*membrane_, time_, position, velocity, direction, product);
  }

 private:
  const Membrane* membrane_;
  double time_;  ///< s
};

std::vector<StageInfo> explain_membrane(const Scene& scene, const ClothSystem& system) {
  if (system.membrane.empty()) return {};
  const Material& m = *scene.material;
  return {{"triangles of constant strain", true,
           fmt::format("{} of {} N/m along the warp, {} along the weft, {} between them, shear {}",
                       system.membrane.size(), m.stretch_warp, m.stretch_weft, coupling_of(m), m.shear)}};
}

}  // namespace

ForceEntry membrane_entry() {
  return {.make = [](const Scene&, const ClothSystem& system) -> std::unique_ptr<Force> {
            return system.membrane.empty() ? nullptr : std::make_unique<MembraneForce>();
          },
          .explain = explain_membrane};
}

ForceEntry membrane_damping_entry() {
  return {.make = [](const Scene& scene, const ClothSystem& system) -> std::unique_ptr<Force> {
            if (system.membrane.empty() || !scene.material || !(scene.material->stretch_damping > 0))
              return nullptr;
            return std::make_unique<MembraneDamping>(system, scene.material->stretch_damping);
          },
          .work = &Work::damping_loss,
          .explain = [](const Scene& scene, const ClothSystem& system) -> std::vector<StageInfo> {
            if (system.membrane.empty()) return {};
            return {coefficient_stage("stretch damping", scene, "material.stretch_damping")};
          }};
}

}  // namespace cloth
