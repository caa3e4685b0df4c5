// The friction of a cloth that bends (cloth/bending_sliders.h): within a step the force of an energy, at its
// end what has slipped is lost.
#include <fmt/format.h>

#include "cloth/bending_sliders.h"
#include "forces/registry.h"
#include "kernels/slider_grid.h"

namespace cloth {
namespace {

/// What the sliders have come to is a list, and beside it, of a grid whose passes take sliders, what those
/// write: the list follows when it is asked for.
class BendingHysteresis : public Force {
 public:
  /// `system` must outlive the force.
  explicit BendingHysteresis(const ClothSystem& system)
      : system_(&system), list_(sliders_at(system, system.start)) {
    if (auto grid = slider_grid(system)) grid_ = std::make_unique<SliderGrid>(std::move(*grid));
    list_changed();
  }

  KernelCoverage join(SweepTerms& terms) const override {
    if (!terms.takes_sliders || !grid_) return KernelCoverage::none;
    terms.sliders = grid_.get();
    return KernelCoverage::every_pass;
  }
  bool is_internal() const override { return true; }
  void update(const ClothSystem& system, const Vec3Field& position, double, Vec3Field& force) override {
    add_slider_force(system.sliders, list(), position, force);
  }
  bool add_node_damping(NodeDamping& damping) const override {
    damping.sliders = &list();
    return true;
  }
  void add_linearisation(const ClothSystem& system, const Vec3Field& position,
                         const LinearisationWeights& weights, Linearisation& to) const override {
    to.slider_slope = slider_slopes(system.sliders, list(), position);
    for (double& slope : to.slider_slope) slope *= weights.position;
    to.slider_normal = list_.normal;
  }

  double stored_energy(const Vec3Field& position) const override {
    return slider_energy(system_->sliders, list(), position);
  }
  double end_step(const Vec3Field& position, Vec3Field* held) override {
    list();
    Vec3Field before(held ? position.size() : 0);
    if (held) add_slider_force(system_->sliders, list_, position, before);
    const double lost = end_slider_step(*system_, position, list_);
    list_changed();
    if (!held) return lost;
    for (std::size_t i = 0; i < position.size(); ++i) held->add(i, -before[i]);
    add_slider_force(system_->sliders, list_, position, *held);
    return lost;
  }
  std::vector<double> history() const override { return list().slip; }
  void set_history(const std::vector<double>& slip, const Vec3Field& position) override {
    list_ = sliders_at(*system_, position);
    if (slip.size() == list_.slip.size()) list_.slip = slip;
    list_changed();
  }

 private:
  const SliderState& list() const {
    if (grid_ && grid_->changes != changes_) {
      grid_->get(system_->sliders, list_);
      changes_ = grid_->changes;
    }
    return list_;
  }
  void list_changed() {
    if (!grid_) return;
    grid_->put(system_->sliders, list_);
    changes_ = grid_->changes;
  }

  const ClothSystem* system_;
  std::unique_ptr<SliderGrid> grid_;
  mutable SliderState list_;
  mutable std::int64_t changes_ = 0;  ///< of the grid, that the list has followed
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
