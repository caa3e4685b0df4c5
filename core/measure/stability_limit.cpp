#include "measure/stability_limit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cloth/grid.h"
#include "cloth/mesh_cloth.h"
#include "measure/amplification.h"
#include "measure/resting_frequency.h"
#include "measure/spectrum.h"

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
double scanned_stiffness(const GridCell& cell, const SpringMaterial& material) {
  constexpr int waves = 32;
  double best = 0, best_x = 0, best_y = 0;
  const auto consider = [&](double qx, double qy) {
    const double value = wave_stiffness(cell, material, qx, qy);
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

/// Whether `method` chooses its own steps in this scene, so that none that is given is too long: the
/// one place that decides it.
bool adapts_its_steps(const std::string& method, const Scene& scene) {
  return method == "dormand-prince" && scene.integrator.tolerance > 0;
}

}  // namespace

double largest_frequency(const ClothSheet& sheet, const SpringMaterial& material) {
  if (sheet.is_mesh()) return resting_frequency(make_cloth(sheet, material));
  const GridCell cell = cell_of(sheet);
  const double stiffness = is_square(cell) ? square_stiffness(material) : scanned_stiffness(cell, material);
  return std::sqrt(stiffness / particle_mass(sheet));
}

double guaranteed_frequency(const ClothSheet& sheet, const SpringMaterial& material) {
  if (sheet.is_mesh()) return guaranteed_frequency(make_cloth(sheet, material));
  // Inside the grid every particle has four springs of each family.
  const double stiffness = 8 * (material.structural + material.shear + material.flexion);
  return std::sqrt(stiffness / particle_mass(sheet));
}

namespace {

using FrequencyOf = double (*)(const ClothSheet&, const SpringMaterial&);

DampingRates rates_of(const Scene& scene, FrequencyOf frequency) {
  DampingRates rates;
  const double mass = particle_mass(scene.cloth);
  rates.least = rates.most = scene.damping.value_or(0) / mass;
  if (scene.air) rates.most += scene.air->drag / mass;
  if (scene.springs && scene.springs->damping > 0) {
    // Spring damping is the stiffness matrix of springs without rest length: each family that exists, weight
    // k_d.
    const double damping = scene.springs->damping;
    const auto weight = [&](double stiffness) { return stiffness > 0 ? damping : 0.0; };
    const SpringMaterial dampers{weight(scene.springs->structural), weight(scene.springs->shear),
                                 weight(scene.springs->flexion), 0};
    rates.most += std::pow(frequency(scene.cloth, dampers), 2);
  }
  return rates;
}

std::optional<double> step_below(const std::string& method, const Scene& scene, FrequencyOf frequency) {
  if (adapts_its_steps(method, scene)) return infinity;
  const double omega = scene.springs ? frequency(scene.cloth, *scene.springs) : 0;
  return stable_step(method, omega, rates_of(scene, frequency));
}

}  // namespace

DampingRates damping_rates(const Scene& scene) {
  return rates_of(scene, largest_frequency);
}

bool stable_at_every_step(const std::string& method) {
  static const std::array<std::string, 5> methods{"implicit-euler", "implicit-midpoint", "bdf2", "projective",
                                                  "xpbd"};
  return std::find(methods.begin(), methods.end(), method) != methods.end();
}

double oscillator_limit(const std::string& method, double omega, double c) {
  if (omega == 0 && c == 0) return infinity;
  if (stable_at_every_step(method)) return infinity;
  if (method == "verlet") return omega > 0 ? 2 / omega : infinity;
  if (method == "semi-implicit-euler") return 4 / (std::sqrt(c * c + 4 * omega * omega) + c);
  if (method == "explicit-euler") {
    const double discriminant = 0.25 * c * c - omega * omega;
    return discriminant < 0 ? c / (omega * omega) : 2 / (0.5 * c + std::sqrt(discriminant));
  }
  return scanned_limit(method, omega, c);
}

std::optional<double> stable_step(const std::string& method, double largest_omega,
                                  const DampingRates& rates) {
  constexpr int scanned_rates = 8;
  double limit = infinity;
  const auto consider = [&](double omega) {
    for (int k = 0; k <= (rates.most > rates.least ? scanned_rates : 0); ++k) {
      const double c = rates.least + (rates.most - rates.least) * k / scanned_rates;
      limit = std::min(limit, oscillator_limit(method, omega, c));
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
  return step_below(method, scene, largest_frequency);
}

std::optional<double> guaranteed_step(const std::string& method, const Scene& scene) {
  return step_below(method, scene, guaranteed_frequency);
}

double provot_step(const Scene& scene) {
  if (!scene.springs) return infinity;
  const double stiffness =
      std::max({scene.springs->structural, scene.springs->shear, scene.springs->flexion});
  return stiffness > 0 ? pi * std::sqrt(particle_mass(scene.cloth) / stiffness) : infinity;
}

}  // namespace cloth
