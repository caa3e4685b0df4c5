#include "measure/stability_limit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cloth/grid.h"
#include "cloth/mesh_cloth.h"
#include "forces/registry.h"
#include "measure/amplification.h"
#include "measure/spectrum.h"
#include "scene/method_facts.h"
#include "scene/scene_cloth.h"

namespace cloth {
namespace {

using std::numbers::pi;

constexpr double scan_ratio = 1.1;  // between two frequencies of a scan

double particle_mass(const ClothSheet& sheet) {
  return sheet.mass / (double(sheet.rows) * sheet.columns);
}

/// m omega^2 of the plane wave (qx, qy) that oscillates fastest.
double wave_stiffness(const GridCell& cell, const SpringMaterial& material, double qx, double qy) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  for (const SpringDirection& direction : spring_directions()) {
    const Vec3 d = (direction.columns * cell.across + direction.rows * cell.down).normalized();
    const double phase = direction.columns * qx + direction.rows * qy;
    matrix += 2 * stiffness_of(material, direction.family) * (1 - std::cos(phase)) * d * d.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

/// The largest value over the Brillouin zone: a grid of waves, then ever smaller neighbourhoods of the best
/// one.
template <class StiffnessOf>  // (qx, qy) in N/m
double scanned_stiffness(const StiffnessOf& stiffness_of_wave) {
  constexpr int waves = 32;
  double best = 0, best_x = 0, best_y = 0;
  const auto consider = [&](double qx, double qy) {
    const double value = stiffness_of_wave(qx, qy);
    if (value > best) best = value, best_x = qx, best_y = qy;
  };
  for (int i = 0; i <= waves; ++i)
    for (int j = -waves; j <= waves; ++j) consider(pi * i / waves, pi * j / waves);
  for (double radius = pi / waves; radius > 1e-7; radius *= 0.5) {
    const double centre_x = best_x, centre_y = best_y;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j) consider(centre_x + i * radius, centre_y + j * radius);
  }
  return best;
}

/// The closed form for square cells: the extremes of the dispersion relation at the zone's corner, along its
/// edge, and along its diagonal.
double square_stiffness(const SpringMaterial& material) {
  const double s = material.structural, h = material.shear, f = material.flexion;
  double largest = 4 * (s + h);
  if (f > 0 && s + h <= 4 * f) largest = std::max(largest, std::pow(s + h + 4 * f, 2) / (4 * f));
  if (h + f > 0 && s <= 4 * (h + f))
    largest = std::max(largest, std::pow(s + 4 * (h + f), 2) / (4 * (h + f)));
  return largest;
}

bool is_square(const GridCell& cell) {
  const double across = cell.across.norm(), down = cell.down.norm();
  return std::abs(across - down) <= 1e-12 * across &&
         std::abs(cell.across.dot(cell.down)) <= 1e-12 * across * down;
}

/// The eigenvalue of the grid's graph Laplacian for the plane wave whose phases across and down have the
/// cosines c and d. N/m
double laplacian_wave(const SpringMaterial& material, double c, double d) {
  return 2 * material.structural * (2 - c - d) + 4 * material.shear * (1 - c * d) +
         4 * material.flexion * (2 - c * c - d * d);
}

/// The largest of them over all waves: at a corner of [-1, 1] x [-1, 1], on its diagonal or on an edge.
double laplacian_stiffness(const SpringMaterial& material) {
  const double s = material.structural, h = material.shear, f = material.flexion;
  const auto clamped = [](double cosine) { return std::clamp(cosine, -1.0, 1.0); };
  double largest = std::max(laplacian_wave(material, -1, -1), laplacian_wave(material, -1, 1));
  const auto consider = [&](double c, double d) {
    largest = std::max(largest, laplacian_wave(material, c, d));
  };
  if (h + 2 * f > 0) {
    const double diagonal = clamped(-s / (2 * h + 4 * f));
    consider(diagonal, diagonal);
  }
  if (f > 0) {
    consider(-1, clamped((2 * h - s) / (4 * f)));
    consider(1, clamped(-(s + 2 * h) / (4 * f)));
  }
  return largest;
}

/// The stiffness of a material's grid for plane waves, N/m.
struct MaterialWaves {
  CellSprings springs;
  CellBending bending;
  Vec3 across, down, diagonals[2];  ///< unit vectors

  explicit MaterialWaves(const Scene& scene) {
    const CellSides sides = cell_sides(scene.cloth);
    const GridCell cell = cell_of(scene.cloth);
    springs = cell_springs(*scene.material, sides.across, sides.down);
    bending = cell_bending(*scene.material, sides.across, sides.down);
    const Material& m = *scene.material;
    if (m.hysteresis_weft > 0) bending.across *= 1 + slider_stiffness_ratio;
    if (m.hysteresis_warp > 0) bending.down *= 1 + slider_stiffness_ratio;
    across = cell.across.normalized(), down = cell.down.normalized();
    diagonals[0] = (cell.across + cell.down).normalized();
    diagonals[1] = (cell.across - cell.down).normalized();
  }

  /// Of bending, for the cosines c and d of the phases across and down: as stiff in every direction.
  double of_bending(double c, double d) const {
    return 4 * (bending.across * (1 - c) * (1 - c) + bending.down * (1 - d) * (1 - d) +
                bending.twist * (1 - c) * (1 - d));
  }
  /// Of the springs, were each as stiff in every direction.
  double of_springs(double c, double d) const {
    return 2 * springs.across * (1 - c) + 2 * springs.down * (1 - d) + 4 * springs.diagonal * (1 - c * d);
  }
  double most_of_springs() const {
    return std::max({of_springs(-1, 1), of_springs(1, -1), of_springs(-1, -1)});
  }
  double most_of_bending() const { return of_bending(-1, -1); }
  /// m omega^2 of the fastest of the three plane waves with these phases, of the flat grid at rest.
  double at_rest(double qx, double qy) const {
    const auto along = [](const Vec3& e) -> Eigen::Matrix3d { return e * e.transpose(); };
    const Eigen::Matrix3d matrix = 2 * (springs.across * (1 - std::cos(qx)) * along(across) +
                                        springs.down * (1 - std::cos(qy)) * along(down) +
                                        springs.diagonal * ((1 - std::cos(qx + qy)) * along(diagonals[0]) +
                                                            (1 - std::cos(qx - qy)) * along(diagonals[1])));
    return of_bending(std::cos(qx), std::cos(qy)) +
           Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly).eigenvalues()[2];
  }
};

/// Of a material on a mesh or on a grid that is cut: what its limits are made of.
struct MeshNumbers {
  double at_rest = 0, guaranteed = 0;  ///< 1/s
  double lightest = 0;                 ///< kg
  double stiffest_edge = 0;            ///< N/m
};

MeshNumbers measured_mesh(const Scene& scene) {
  const ClothSystem system = make_cloth(scene);
  const Spectrum spectrum = measure_spectrum(system, system.start);
  MeshNumbers numbers{.guaranteed = guaranteed_frequency(system),
                      .lightest = *std::min_element(system.mass.begin(), system.mass.end())};
  numbers.at_rest =
      std::min(numbers.guaranteed, std::sqrt(std::max(0.0, spectrum.largest) + spectrum.largest_residual));
  numbers.stiffest_edge = stiffest_edge(system.membrane);
  return numbers;
}

/// They are asked for once for every method and limit of one scene, and measured once for all of them.
const MeshNumbers& mesh_numbers(const Scene& scene) {
  struct Known {
    ClothSheet cloth;
    Material material;
    MeshNumbers numbers;
  };
  thread_local std::optional<Known> last;
  if (!last || !(last->cloth == scene.cloth) || !(last->material == *scene.material))
    last = Known{scene.cloth, *scene.material, measured_mesh(scene)};
  return last->numbers;
}

/// Whether `method` chooses its own steps in this scene, so that none that is given is too long: the
/// one place that decides it.
bool adapts_its_steps(const std::string& method, const Scene& scene) {
  return facts_of(method).controls_error && scene.integrator.tolerance > 0;
}

}  // namespace

double largest_frequency(const ClothSheet& sheet, const SpringMaterial& material) {
  if (sheet.is_mesh()) return resting_frequency(make_cloth(sheet, material));
  const GridCell cell = cell_of(sheet);
  const double stiffness =
      is_square(cell)
          ? square_stiffness(material)
          : scanned_stiffness([&](double qx, double qy) { return wave_stiffness(cell, material, qx, qy); });
  return std::sqrt(stiffness / particle_mass(sheet));
}

double guaranteed_frequency(const ClothSheet& sheet, const SpringMaterial& material) {
  if (sheet.is_mesh()) return guaranteed_frequency(make_cloth(sheet, material));
  return std::sqrt(laplacian_stiffness(material) / particle_mass(sheet));
}

namespace {

/// A corner of the material's grid, without pins: where springs at edges are weak, what lies at an edge or a
/// corner oscillates faster than any wave inside.
double frequency_at_edges(const Scene& scene) {
  constexpr int size = 8;
  Scene patch = scene;
  patch.cloth.pins.clear();
  patch.cloth.rows = std::min(scene.cloth.rows, size),
  patch.cloth.columns = std::min(scene.cloth.columns, size);
  patch.cloth.height *= double(patch.cloth.rows - 1) / (scene.cloth.rows - 1);
  patch.cloth.width *= double(patch.cloth.columns - 1) / (scene.cloth.columns - 1);
  const ClothSystem system = make_cloth(patch);
  const Spectrum spectrum = measure_spectrum(system, system.start);
  return std::sqrt(spectrum.largest + spectrum.largest_residual);
}

}  // namespace

double largest_frequency(const Scene& scene) {
  if (!scene.material) return scene.springs ? largest_frequency(scene.cloth, *scene.springs) : 0;
  if (scene.cloth.is_mesh() || scene.cloth.is_cut()) return mesh_numbers(scene).at_rest;
  const MaterialWaves waves(scene);
  const double inside = scanned_stiffness([&](double qx, double qy) { return waves.at_rest(qx, qy); });
  if (!(inside > 0)) return 0;
  return std::min(guaranteed_frequency(scene),
                  std::max(std::sqrt(inside / particle_mass(scene)), frequency_at_edges(scene)));
}

double guaranteed_frequency(const Scene& scene) {
  if (!scene.material) return scene.springs ? guaranteed_frequency(scene.cloth, *scene.springs) : 0;
  if (scene.cloth.is_mesh() || scene.cloth.is_cut()) return mesh_numbers(scene).guaranteed;
  const MaterialWaves waves(scene);
  return std::sqrt((waves.most_of_springs() + waves.most_of_bending()) / particle_mass(scene));
}

namespace {

/// L + k e e^T has the largest eigenvalue at which k e^T (most - L)^-1 e = 1; over the waves of the grid.
template <class WaveStiffness>  // (cosine across, cosine down) in N/m
double greens_stiffness(double most, const WaveStiffness& stiffness_of_wave) {
  constexpr int waves = 64;
  double compliance = 0;
  for (int i = 0; i < waves; ++i)
    for (int j = 0; j < waves; ++j)
      compliance +=
          1 / (most - stiffness_of_wave(std::cos(pi * (i + 0.5) / waves), std::cos(pi * (j + 0.5) / waves)));
  return waves * waves / compliance;
}

}  // namespace

double strongest_held_spring(const ClothSheet& sheet, const SpringMaterial& material, double omega) {
  const double most = particle_mass(sheet) * omega * omega;
  const double largest = particle_mass(sheet) * std::pow(guaranteed_frequency(sheet, material), 2);
  if (!(most > largest)) return 0;
  if (sheet.is_mesh()) return most - largest;
  return greens_stiffness(most, [&](double c, double d) { return laplacian_wave(material, c, d); });
}

double strongest_held_spring(const Scene& scene, double omega) {
  if (!scene.material)
    return strongest_held_spring(scene.cloth, scene.springs.value_or(SpringMaterial{}), omega);
  if (scene.cloth.is_mesh() || scene.cloth.is_cut()) {
    const MeshNumbers& numbers = mesh_numbers(scene);
    return std::max(0.0, numbers.lightest * (omega * omega - numbers.guaranteed * numbers.guaranteed));
  }
  const MaterialWaves waves(scene);
  const double most = particle_mass(scene) * omega * omega;
  if (!(most > waves.most_of_springs() + waves.most_of_bending())) return 0;
  return greens_stiffness(
      most, [&](double c, double d) { return waves.of_springs(c, d) + waves.of_bending(c, d); });
}

namespace {

/// Which of the two frequencies a limit is of.
struct Frequency {
  double (*of_scene)(const Scene&);
  double (*of_springs)(const ClothSheet&, const SpringMaterial&);
};
constexpr Frequency at_rest{largest_frequency, largest_frequency},
    in_any_shape{guaranteed_frequency, guaranteed_frequency};

/// Damping in proportion to stiffness, as a rate in 1/s: t omega^2 with the damping time t.
double stiffness_damping(const Scene& scene) {
  if (scene.cloth.is_mesh())
    return std::max(scene.material->stretch_damping, scene.material->bending_damping) *
           std::pow(guaranteed_frequency(scene), 2);
  const MaterialWaves waves(scene);
  return (scene.material->stretch_damping * waves.most_of_springs() +
          scene.material->bending_damping * waves.most_of_bending()) /
         particle_mass(scene);
}

/// The dampers as springs of stiffness k_d, in the families that exist.
SpringMaterial dampers_of(const SpringMaterial& springs) {
  const auto weight = [&](double stiffness) { return stiffness > 0 ? springs.damping : 0.0; };
  return {weight(springs.structural), weight(springs.shear), weight(springs.flexion), 0};
}

DampingRates rates_of(const Scene& scene, const Frequency& frequency) {
  DampingRates rates;
  const double mass = particle_mass(scene);
  const NodeDamping damping = particle_damping(scene);
  rates.least = damping.isotropic.of(mass) / mass + damping.along_normal.negative().of(mass) / mass;
  rates.most = damping.isotropic.of(mass) / mass + damping.along_normal.positive().of(mass) / mass;
  if (scene.springs && scene.springs->damping > 0) {
    // Spring damping is the stiffness matrix of springs without rest length.
    rates.most += std::pow(frequency.of_springs(scene.cloth, dampers_of(*scene.springs)), 2);
  }
  if (scene.material) rates.most += stiffness_damping(scene);
  return rates;
}

std::optional<double> step_below(const std::string& method, const Scene& scene, const Frequency& frequency) {
  if (adapts_its_steps(method, scene)) return infinity;
  return stable_step(method, frequency.of_scene(scene), rates_of(scene, frequency));
}

/// A bound on the largest eigenvalue of h^2 K + weight h C in every shape of a grid of springs, N/m. Springs
/// and dampers are bounded together: the wave that is largest for the one need not be so for the other.
double joint_stiffness(const Scene& scene, double h, double weight) {
  const SpringMaterial& springs = *scene.springs;
  const SpringMaterial dampers = dampers_of(springs);
  const NodeDamping damping = particle_damping(scene);
  const double mass = particle_mass(scene);
  const double drag = damping.isotropic.of(mass) + damping.along_normal.positive().of(mass);
  const SpringMaterial both{h * h * springs.structural + weight * h * dampers.structural,
                            h * h * springs.shear + weight * h * dampers.shear,
                            h * h * springs.flexion + weight * h * dampers.flexion, 0};
  return laplacian_stiffness(both) + weight * h * drag;
}

/// Semi-implicit Euler on x'' = -(K x + C x')/m does not grow while h^2 K + 2 h C < 4 m. s
double joint_euler_step(const Scene& scene) {
  const auto is_stable = [&](double h) { return joint_stiffness(scene, h, 2) <= 4 * particle_mass(scene); };
  double stable = 0, unstable = 2 / guaranteed_frequency(scene.cloth, *scene.springs);
  if (is_stable(unstable)) return unstable;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (stable + unstable);
    (is_stable(middle) ? stable : unstable) = middle;
  }
  return stable;
}

/// The same of a material, whose dampers are in proportion to its stiffness: h^2 omega^2 + 2 h c < 4.
double joint_euler_step_of_material(const Scene& scene) {
  const double square = std::pow(guaranteed_frequency(scene), 2), rate = rates_of(scene, in_any_shape).most;
  return 4 / (rate + std::sqrt(rate * rate + 4 * square));
}

}  // namespace

DampingRates damping_rates(const Scene& scene) {
  return rates_of(scene, at_rest);
}

bool stable_at_every_step(const std::string& method) {
  return facts_of(method).a_stable;
}

double oscillator_limit(const std::string& method, double omega, double c, double at_most) {
  if (omega == 0 && c == 0) return infinity;
  const MethodFacts& facts = facts_of(method);
  if (facts.a_stable) return infinity;
  return facts.limit ? facts.limit(omega, c) : scanned_limit(method, omega, c, at_most);
}

std::optional<double> stable_step(const std::string& method, double largest_omega,
                                  const DampingRates& rates) {
  constexpr int scanned_rates = 8;
  double limit = infinity;
  const auto consider = [&](double omega) {
    for (int k = 0; k <= (rates.most > rates.least ? scanned_rates : 0); ++k) {
      const double c = rates.least + (rates.most - rates.least) * k / scanned_rates;
      limit = std::min(limit, oscillator_limit(method, omega, c, limit));
    }
  };
  consider(0);
  // Slower motions matter too: a heavily damped slow one decays faster than a fast one oscillates.
  if (largest_omega > 0)
    for (double omega = largest_omega; omega > 1e-3 * largest_omega; omega /= scan_ratio) consider(omega);
  if (!(limit > 0)) return std::nullopt;
  return limit;
}

std::optional<double> stable_step(const std::string& method, const Scene& scene) {
  return step_below(method, scene, at_rest);
}

std::optional<double> guaranteed_step(const std::string& method, const Scene& scene) {
  const auto apart = step_below(method, scene, in_any_shape);
  if (facts_of(method).bounds_jointly && scene.material && guaranteed_frequency(scene) > 0)
    return joint_euler_step_of_material(scene);
  if (!facts_of(method).bounds_jointly || scene.cloth.is_mesh() || !scene.springs ||
      !(scene.springs->damping > 0))
    return apart;
  return joint_euler_step(scene);
}

double predicted_damping_load(const Scene& scene, double step) {
  if (scene.springs && !scene.material && !scene.cloth.is_mesh())
    return joint_stiffness(scene, step, 4) / (4 * particle_mass(scene));
  return 0.25 * std::pow(step * guaranteed_frequency(scene), 2) + step * rates_of(scene, in_any_shape).most;
}

double damping_load(const Scene& scene, double step) {
  return step * rates_of(scene, in_any_shape).most;
}

double explicit_step_limit(const Scene& scene) {
  const double omega = guaranteed_frequency(scene);
  return omega > 0 ? 2 / omega : infinity;
}

double provot_step(const Scene& scene) {
  double stiffness = 0;
  if (const auto& s = scene.springs) stiffness = std::max({s->structural, s->shear, s->flexion});
  if (scene.material && scene.cloth.is_mesh()) {
    stiffness = mesh_numbers(scene).stiffest_edge;
  } else if (scene.material) {
    const CellSprings k = MaterialWaves(scene).springs;
    stiffness = std::max({k.across, k.down, k.diagonal});
  }
  return stiffness > 0 ? pi * std::sqrt(particle_mass(scene) / stiffness) : infinity;
}

}  // namespace cloth
