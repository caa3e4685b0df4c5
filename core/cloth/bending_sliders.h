// Friction between the threads of a cloth that bends: its moment lags behind by up to half of the width of
// the loop that a bending tester draws, 2HB of the KES (Kawabata 1980). Beside the elastic moment B kappa
// acts a slider, elastic and then plastic:
//
//     M = B kappa + K (kappa - slip),   |K (kappa - slip)| <= HB
//
// kappa is the scalar curvature along warp or weft about a normal that is held during a step; at its end the
// slip follows where the slider has yielded, and the normal is taken anew. A vector that stays in space as
// the cloth turns would not do: its moment would depend on how the cloth has turned. Bent far and let go, a
// cloth keeps the curvature HB/B. Nothing is measured of K; it is taken as 4 B, so that a cloth yields at the
// curvature HB/(4 B).
#pragma once

#include <array>
#include <vector>

#include "cloth/bending.h"
#include "geometry/vec3_field.h"

namespace cloth {

/// kappa = n . sum_p c_p x_p in 1/m.
struct BendingSlider {
  int points = 0;
  int normal_points = 1;  ///< so many of the first have the normals whose mean is n
  std::array<int, BendingRun::most_points> particle{};
  std::array<double, BendingRun::most_points> coefficient{};
  double area = 0;       ///< m^2
  double stiffness = 0;  ///< K, N m
  double yield = 0;      ///< HB, N
  bool operator==(const BendingSlider&) const = default;
};
using BendingSliders = std::vector<BendingSlider>;

/// K over B.
inline constexpr double slider_stiffness_ratio = 4;

/// What the sliders of a cloth have come to.
struct SliderState {
  std::vector<double> slip;  ///< 1/m
  Vec3Field normal;          ///< unit vectors
};

struct ClothSystem;

/// Of a cloth that has been flat so far, with the normals at `position`.
SliderState sliders_at(const ClothSystem& system, const Vec3Field& position);

/// The energy in J that sliders held like this store, and what those that yield would lose: its slope is
/// their force as long as slips and normals stay.
double slider_energy(const BendingSliders& sliders, const SliderState& state, const Vec3Field& position);

/// force += that slope's opposite, N.
void add_slider_force(const BendingSliders& sliders, const SliderState& state, const Vec3Field& position,
                      Vec3Field& force);

/// Lets slips follow and takes normals anew at the end of a step. Returns the energy in J that is gone.
double end_slider_step(const ClothSystem& system, const Vec3Field& position, SliderState& state);

/// N m m^2 of each slider: the slope of its moment times its area; 0 where it yields.
std::vector<double> slider_slopes(const BendingSliders& sliders, const SliderState& state,
                                  const Vec3Field& position);

/// K in every direction as a sum over pairs, as for_each_bending_pair(): visit(i, j, k_ij) in N/m.
template <class Visit>
void for_each_slider_pair(const BendingSliders& sliders, Visit visit) {
  for (const BendingSlider& s : sliders)
    for (std::size_t p = 0; p < static_cast<std::size_t>(s.points); ++p)
      for (std::size_t q = p + 1; q < static_cast<std::size_t>(s.points); ++q)
        visit(static_cast<std::size_t>(s.particle[p]), static_cast<std::size_t>(s.particle[q]),
              -s.stiffness * s.area * s.coefficient[p] * s.coefficient[q]);
}

}  // namespace cloth
