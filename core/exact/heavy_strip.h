// The strip that is clamped horizontally and bends under its own weight, the test of ASTM D1388, and the
// loads at which a heavy strip buckles. Gamma = mu g L^3/B: areal density (kg/m2), gravity (m/s2), length
// that is free (m), bending stiffness (N m). Lengths of results are in L.
//
//     heavy_cantilever(8).droop_over_width   // 0.8843303
#pragma once

#include <vector>

#include "exact/elastica.h"

namespace cloth::exact {

inline double load_number(double areal_density, double gravity, double length, double bending) {
  return areal_density * gravity * length * length * length / bending;
}

struct HeavyCantilever {
  std::vector<ElasticaPoint> points;  ///< from the clamp at (0, 0), to the right and down
  double droop = 0, width = 0;        ///< of the tip: H below the clamp and W beside it
  double droop_over_width = 0;
  double tip_angle = 0;  ///< rad below the horizontal
};

/// theta'' = -Gamma (1 - s) cos theta, theta(0) = 0, theta'(1) = 0 (Bickley 1934). Shot from the free end, at
/// the logarithm of its angle from straight down: of the many solutions of a heavy strip the one that falls
/// straight to its rest. Gamma > 0.
HeavyCantilever heavy_cantilever(double gamma);

/// At which Gamma the line from the clamp to the tip is at this angle (rad) below the horizontal, 0.05
/// to 1.5.
double gamma_of_chord(double angle);

/// The bending length (B/(mu g))^(1/3) (Peirce 1930), m.
double bending_length(double bending, double areal_density, double gravity);

/// ASTM D1388: the strip is pushed out until its chord is at 41.5 degrees.
inline constexpr double astm_chord = 41.5 * pi / 180;  // rad
/// Overhang (m) -> bending length (m): a half, but for 0.02 %.
double astm_bending_length(double overhang);

/// Gamma at which a strip that stands on a clamp buckles: 9/4 j^2, j the first zero of J_(-1/3) (Greenhill
/// 1881). 7.837347.
double self_buckling_gamma();

/// Gamma at which a slender strip on edge, clamped at one end, tilts: 6 j sqrt(2 B_t/B), j the first zero of
/// J_(-1/6) (Timoshenko and Gere 1961, section 6.3: 12.85 sqrt(E I C), with E I = B and C = 2 B_t per width).
/// 12.8538 sqrt(2 B_t/B).
double lateral_buckling_gamma(double twist_over_bending);

}  // namespace cloth::exact
