// Bending elements of a cloth with pins, put together into runs.
#pragma once

#include "cloth/cloth_system.h"

namespace cloth {

/// Collects elements one after the other into runs of elements that are alike. An element whose middle and
/// one end are pinned bends on its free side alone, over half the length, so that its stiffness doubles; so
/// does that of the twist of a cell with three pinned corners. What has no free particle is left out.
class BendingBuilder {
 public:
  explicit BendingBuilder(ClothSystem& system) : system_(system) {}

  /// An element whose first point is `first`, without its stiffness' factor at clamps.
  void add(int first, const BendingRun& element, double stiffness) {
    BendingRun run = element;
    run.first = first, run.count = 1;
    run.stiffness = stiffness * clamp_factor(run);
    if (!(run.stiffness > 0)) return;
    if (!system_.bending.empty()) {
      BendingRun& last = system_.bending.back();
      if (last.stiffness == run.stiffness && last.offset == run.offset && last.first + last.count == first) {
        ++last.count;
        return;
      }
    }
    system_.bending.push_back(run);
  }

  /// A slider beside the element of three neighbours in a line, `spacing` (m) apart, that stands for `area`
  /// (m2) where it bends on both sides: at a clamp its curvature is twice as large, over half of the area.
  /// `stiffness` in N m, `yield` in N; none without a yield.
  void add_slider(int before, int middle, int after, double spacing, double area, double stiffness,
                  double yield) {
    const BendingRun line{.first = before, .points = 3, .offset = {0, middle - before, after - before}};
    const double factor = clamp_factor(line);
    if (!(factor > 0) || !(yield > 0) || !(area > 0)) return;
    const double c = factor / (spacing * spacing);
    system_.sliders.push_back({.points = 3,
                               .particle = {middle, before, after},
                               .coefficient = {-2 * c, c, c},
                               .area = area / factor,
                               .stiffness = stiffness,
                               .yield = yield});
  }

 private:
  bool pinned(const BendingRun& run, std::size_t point) const {
    return system_.pinned[static_cast<std::size_t>(run.first + run.offset[point])] != 0;
  }
  double clamp_factor(const BendingRun& run) const {
    int held = 0;
    for (std::size_t p = 0; p < static_cast<std::size_t>(run.points); ++p) held += pinned(run, p);
    if (held == run.points) return 0;
    if (run.points == 4) return held == 3 ? 2 : 1;
    return held == 2 && pinned(run, 1) ? 2 : 1;
  }

  ClothSystem& system_;
};

}  // namespace cloth
