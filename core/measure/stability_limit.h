// Stability limits of the time step: the largest frequency of the cloth, and each method's limit for it.
//
// Two frequencies are used: that of the flat, infinite grid at rest (finite or pinned grids have lower ones),
// and an upper bound for every shape, 1.15 to 1.41 times higher. Stretching, shearing or crumpling raises the
// frequency of a cloth from the first towards the second.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "scene/scene.h"

namespace cloth {

/// Largest circular frequency in 1/s of the flat grid at rest: closed form for square cells, the largest
/// eigenvalue over the Brillouin zone otherwise. 0 without springs.
double largest_frequency(const ClothSheet& sheet, const SpringMaterial& material);

/// The least upper bound in 1/s for every shape and stretch. A spring's tangent stiffness is
/// k (n n^T + (1 - L/l) (I - n n^T)) <= k I in any shape, so that omega^2 <= Lambda/m with Lambda the largest
/// eigenvalue of the scalar graph Laplacian of the springs: for a grid in closed form, unbounded, whatever
/// its cells; for a mesh see spectrum.h. 0 without springs.
double guaranteed_frequency(const ClothSheet& sheet, const SpringMaterial& material);

/// The same of a scene, of springs or of a material; 0 where it has neither. Of a material the first is that
/// of the wave that oscillates fastest, or of a motion at the edges of a small sheet of the same cells, the
/// second 2 sqrt of the largest eigenvalue that a cell, a line and a twist alone have (Irons and Treharne
/// 1971): 4/m max(k_x + 2 k_d, k_y + 2 k_d, k_x + k_y) of the springs, 16 (w_x + w_y + w_t)/m of the bending
/// elements, m the mass of a particle inside.
double largest_frequency(const Scene& scene);
double guaranteed_frequency(const Scene& scene);

/// The stiffest spring in N/m that may hold one particle to a fixed point so that no shape of the cloth has a
/// frequency above `omega` in 1/s; 0 where the cloth alone may pass it. Of a grid by its Green's function,
/// for a perturbation of rank one (Golub 1973); of a mesh by Weyl's inequality (1912), which is more careful.
double strongest_held_spring(const ClothSheet& sheet, const SpringMaterial& material, double omega);

/// The same of a scene with springs or a material, for a particle inside.
double strongest_held_spring(const Scene& scene, double omega);

/// Damping rates c = C/m in 1/s: x'' = -omega^2 x - c x'.
struct DampingRates {
  double least = 0;  ///< what every motion feels
  double most = 0;   ///< in the direction of the strongest drag, with spring damping at its largest
};
DampingRates damping_rates(const Scene& scene);

/// Whether `method` is stable for every oscillator at every step (A-stable). Linear only: of a cloth that
/// bends and buckles it says that small motions about a stable shape do not grow, no more.
bool stable_at_every_step(const std::string& method);

/// The largest stable step in s of `method` for the one oscillator x'' = -omega^2 x - c x'; 0 if none is
/// stable, infinity if all are. Closed forms (Jury's test on the matrices of amplification.h) for Verlet,
/// semi-implicit and explicit Euler; scanned_limit() for Runge-Kutta 4 and Dormand-Prince, whose scan ends at
/// `at_most`, in s: a limit that is longer may come out as infinity.
double oscillator_limit(const std::string& method, double omega, double c,
                        double at_most = std::numeric_limits<double>::infinity());

/// The largest step in s at which `method` is stable for x'' = -omega^2 x - c x' for every omega in [0,
/// largest] and c in `rates`. nullopt: no step is stable (explicit Euler without damping of every motion).
/// infinity: no step is too long.
std::optional<double> stable_step(const std::string& method, double largest_omega, const DampingRates& rates);

/// The limit of `method` for this scene: stable_step() at the frequency of the flat grid.
std::optional<double> stable_step(const std::string& method, const Scene& scene);

/// The limit of `method` for every shape of the cloth, with damping at its bounds: below it no stretching or
/// crumpling makes energy grow exponentially. The stability gauge compares the time step with it.
std::optional<double> guaranteed_step(const std::string& method, const Scene& scene);

/// A bound on the largest eigenvalue of (h^2 K + 4 h D)/(4 m) in every shape of the cloth, K its stiffness
/// and D its damping: below 1 Verlet is stable at the step h (s) with its damping at predicted velocities
/// (integrators/verlet.h). Springs and dampers of a grid are bounded together, by the waves of the grid's
/// graph Laplacian; those of meshes and of materials each by itself.
double predicted_damping_load(const Scene& scene, double step);
/// A bound on the largest eigenvalue of h D/m in every shape of the cloth.
double damping_load(const Scene& scene, double step);
/// Up to these damping_load()s Verlet may evaluate its damping twice, and three times, instead of solving for
/// it (integrators/verlet.h): beyond 1 two evaluations damp ever less, and three are stable below 2, of which
/// a little is left for rounding.
inline constexpr double largest_corrected_load = 1, largest_corrected_twice_load = 1.95;
/// Up to this load damping is predicted: the rest is left for rounding and for motions near the limit, which
/// the prediction damps too little.
inline constexpr double largest_predicted_load = 0.95;

/// 2 / omega in s at the guaranteed frequency: no explicit method with one force evaluation is stable at a
/// longer step. infinity without springs.
double explicit_step_limit(const Scene& scene);

/// Provot's criterion (1995): pi sqrt(m/k), k the largest stiffness; 3 to 5 times too long for a grid.
/// infinity without springs.
double provot_step(const Scene& scene);

}  // namespace cloth
