// The sliders of hysteresis (cloth/bending_sliders.h) of a grid assembled cell by cell, in the places of its
// particles, for the passes over its rows. What general methods read is a list, in the order of
// ClothSystem::sliders.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cloth/cloth_system.h"
#include "kernels/grid_pass.h"

namespace cloth {

/// The sliders along rows, or along columns, each at its middle particle.
struct SlidersAlong {
  std::vector<double> curvature;        ///< 1/m^2, c in kappa = c n . (x_- - 2 x + x_+); 0: no slider
  std::vector<double> slip, next_slip;  ///< 1/m
  double push = 0;                      ///< N m, of a whole slider, see kernels::SliderLine
  double most = 0;                      ///< 1/m
  double curvature_of_whole = 1;        ///< 1/m^2
  kernels::SliderLine line();
};

struct SliderGrid {
  SlidersAlong across, down;
  Vec3Field normal, next_normal;  ///< unit vectors, of every particle
  std::int64_t changes = 0;       ///< by passes so far: a list made before one is out of date

  kernels::SliderPass pass();
  /// Makes what a pass has written the present state.
  void take_next_normals();
  void take_next();
  /// From and to the list.
  void put(const BendingSliders& sliders, const SliderState& list);
  void get(const BendingSliders& sliders, SliderState& list) const;
};

/// Nothing where `system` has no sliders, or others than make_material_grid makes.
std::optional<SliderGrid> slider_grid(const ClothSystem& system);

}  // namespace cloth
