// The friction of a cloth that bends (cloth/bending_sliders.h): within a step the force of an energy, at its
// end what has slipped is lost.
#include <fmt/format.h>

#include "cloth/bending_sliders.h"
#include "forces/registry.h"

namespace cloth {
namespace {

class BendingHysteresis : public Force {
 public:
  /// `system` must outlive the force.
  explicit BendingHysteresis(const ClothSystem& system)
      : system_(&system), state_(sliders_at(system, system.start)) {}

  bool is_internal() const override { return true; }
  void update(const ClothSystem& system, const Vec3Field& position, double, Vec3Field& force) override {
    add_slider_force(system.sliders, state_, position, force);
  }
  bool add_node_damping(NodeDamping& damping) const override {
    damping.sliders = &state_;
    return true;
  }
  void add_linearisation(const ClothSystem& system, const Vec3Field& position,
                         const LinearisationWeights& weights, Linearisation& to) const override {
    to.slider_slope = slider_slopes(system.sliders, state_, position);
    for (double& slope : to.slider_slope) slope *= weights.position;
    to.slider_normal = state_.normal;
  }

  double stored_energy(const Vec3Field& position) const override {
    return slider_energy(system_->sliders, state_, position);
  }
  double end_step(const Vec3Field& position) override {
    return end_slider_step(*system_, position, state_);
  }
  std::vector<double> history() const override { return state_.slip; }
  void set_history(const std::vector<double>& slip, const Vec3Field& position) override {
    state_ = sliders_at(*system_, position);
    if (slip.size() == state_.slip.size()) state_.slip = slip;
  }

 private:
  const ClothSystem* system_;
  SliderState state_;
};

std::vector<StageInfo> explain_hysteresis(const Scene& scene, const ClothSystem& system) {
  if (!scene.material) return {};
  if (system.sliders.empty())
    return {{"bending hysteresis", false, "material.hysteresis_warp and hysteresis_weft are 0"}};
  return {{"bending hysteresis", true,
           fmt::format("{} sliders, 2HB {} N along the warp, {} N along the weft", system.sliders.size(),
                       scene.material->hysteresis_warp, scene.material->hysteresis_weft)}};
}

}  // namespace

ForceEntry hysteresis_entry() {
  return {.make = [](const Scene&, const ClothSystem& system) -> std::unique_ptr<Force> {
            return system.sliders.empty() ? nullptr : std::make_unique<BendingHysteresis>(system);
          },
          .work = &Work::hysteresis_loss,
          .explain = explain_hysteresis};
}

}  // namespace cloth
