// How long a step may be: the largest frequency of the cloth and each method's limit for it.
//
// The frequency is that of the flat grid at rest, unbounded; a finite or pinned grid has less. Stretching
// raises it (a factor 1.02 at 10 %), so that a margin below the limit is needed.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.h"

namespace cloth {

/// Largest circular frequency in 1/s of the flat grid at rest: closed form for square cells, the largest
/// eigenvalue over the Brillouin zone otherwise. 0 without springs.
double largest_frequency(const ClothSheet& sheet, const SpringMaterial& material);

/// An upper bound in 1/s for any configuration, any stretch: omega^2 <= 2 max_i (1/m_i) sum_j k_ij.
double guaranteed_frequency(const ClothSheet& sheet, const SpringMaterial& material);

/// Damping rates c = C/m in 1/s: x'' = -omega^2 x - c x'.
struct DampingRates {
  double least = 0;  ///< what every motion feels: viscous damping
  double most = 0;   ///< with air along the normal and spring damping at its largest
};
DampingRates damping_rates(const Scene& scene);

/// Whether `method` is stable for every oscillator at every step (A-stable). Linear only: of a cloth that
/// bends and buckles it says that small motions about a stable shape do not grow, no more.
bool stable_at_every_step(const std::string& method);

/// The largest stable step in s of `method` for the one oscillator x'' = -omega^2 x - c x'; 0 if none is
/// stable, infinity if all are. Closed forms (Jury's test on the matrices of amplification.h) for Verlet,
/// semi-implicit and explicit Euler; scanned_limit() for Runge-Kutta 4 and Dormand-Prince.
double oscillator_limit(const std::string& method, double omega, double c);

/// The largest step in s at which `method` is stable for x'' = -omega^2 x - c x' for every omega in [0,
/// largest] and c in `rates`. nullopt: no step is stable (explicit Euler without damping of every motion).
/// infinity: no step is too long.
std::optional<double> stable_step(const std::string& method, double largest_omega, const DampingRates& rates);

/// The limit of `method` for this scene: stable_step() at the frequency of the flat grid.
std::optional<double> stable_step(const std::string& method, const Scene& scene);

/// The same at the bounds that hold for any shape: what stretching cannot make unstable.
std::optional<double> guaranteed_step(const std::string& method, const Scene& scene);

/// Provot's criterion (1995): pi sqrt(m/k), k the largest stiffness; 3 to 5 times too long for a grid.
/// infinity without springs.
double provot_step(const Scene& scene);

}  // namespace cloth
