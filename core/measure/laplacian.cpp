// The bound on a cloth's frequencies that holds in every shape: the scalar graph Laplacian of its springs. Of
// triangles of constant strain, which get stiffer as they are stretched, it holds as long as no edge is longer
// than covered_stretch times its rest length.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/split_mix.h"
#include "measure/spectrum.h"

namespace cloth {
namespace {

using Eigen::Index;

/// u -> M^-1/2 L M^-1/2 u with one number for each particle; pinned ones do not move.
class ScaledLaplacian {
 public:
  explicit ScaledLaplacian(const ClothSystem& system) : system_(system), scale_(system.size()) {
    for (int i = 0; i < system.size(); ++i)
      scale_[i] = std::sqrt(system.inverse_mass[static_cast<std::size_t>(i)]);
  }

  Eigen::VectorXd operator*(const Eigen::VectorXd& vector) const {
    const Eigen::VectorXd u = scale_.cwiseProduct(vector);
    Eigen::VectorXd product = Eigen::VectorXd::Zero(u.size());
    for_each_spring(system_.springs, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
      const double force = run.stiffness * (u[i] - u[j]);
      product[i] += force;
      product[j] -= force;
    });
    for_each_bending_pair(system_.bending, [&](std::size_t i, std::size_t j, double stiffness) {
      const double force = stiffness * (u[Index(i)] - u[Index(j)]);
      product[Index(i)] += force;
      product[Index(j)] -= force;
    });
    for_each_slider_pair(system_.sliders, [&](std::size_t i, std::size_t j, double stiffness) {
      const double force = stiffness * (u[Index(i)] - u[Index(j)]);
      product[Index(i)] += force;
      product[Index(j)] -= force;
    });
    for_each_membrane_bound([&](std::size_t i, std::size_t j, double stiffness) {
      const double force = stiffness * (u[Index(i)] - u[Index(j)]);
      product[Index(i)] += force;
      product[Index(j)] -= force;
    });
    return scale_.cwiseProduct(product);
  }

  /// Gershgorin's bound of each row: twice the diagonal, springs to pins once. 1/s^2
  Eigen::VectorXd row_bounds() const {
    Eigen::VectorXd stiffness = Eigen::VectorXd::Zero(scale_.size());
    for_each_spring(system_.springs, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
      stiffness[i] += (scale_[j] > 0 ? 2 : 1) * run.stiffness;
      stiffness[j] += (scale_[i] > 0 ? 2 : 1) * run.stiffness;
    });
    for_each_bending_pair(system_.bending, [&](std::size_t i, std::size_t j, double of_pair) {
      stiffness[Index(i)] += of_pair + (scale_[Index(j)] > 0 ? std::abs(of_pair) : 0);
      stiffness[Index(j)] += of_pair + (scale_[Index(i)] > 0 ? std::abs(of_pair) : 0);
    });
    for_each_slider_pair(system_.sliders, [&](std::size_t i, std::size_t j, double of_pair) {
      stiffness[Index(i)] += of_pair + (scale_[Index(j)] > 0 ? std::abs(of_pair) : 0);
      stiffness[Index(j)] += of_pair + (scale_[Index(i)] > 0 ? std::abs(of_pair) : 0);
    });
    for_each_membrane_bound([&](std::size_t i, std::size_t j, double of_edge) {
      stiffness[Index(i)] += (scale_[Index(j)] > 0 ? 2 : 1) * of_edge;
      stiffness[Index(j)] += (scale_[Index(i)] > 0 ? 2 : 1) * of_edge;
    });
    return scale_.cwiseProduct(scale_).cwiseProduct(stiffness);
  }

 private:
  template <class Visit>  // visit(i, j, stiffness in N/m)
  void for_each_membrane_bound(Visit visit) const {
    for (const MembraneTriangle& t : system_.membrane) {
      const std::array<double, 3> bound = edge_bounds(t);
      for (std::size_t e = 0; e < 3; ++e) visit(cloth::at(t.corner[e]), cloth::at(t.corner[(e + 1) % 3]), bound[e]);
    }
  }

  const ClothSystem& system_;
  Eigen::VectorXd scale_;  ///< 1/sqrt(kg); 0 where pinned
};

/// Random signs that are the same everywhere, larger where springs are: a few stiff
/// particles among many soft ones are found soon.
Eigen::VectorXd laplacian_start(const Eigen::VectorXd& row_bounds) {
  SplitMix random(1);
  Eigen::VectorXd start = row_bounds.cwiseProduct(row_bounds) / std::pow(row_bounds.maxCoeff(), 2);
  for (double& value : start) value *= random.number();
  return start.normalized();
}

}  // namespace

/// Lanczos iteration without reorthogonalisation: copies of found eigenvalues do no harm where only the
/// largest is asked for (Paige 1971). That its residual may be added to bound it from above: Zhou and Li
/// 2011.
double guaranteed_frequency(const ClothSystem& system) {
  constexpr std::array<std::size_t, 4> looks{20, 40, 80, 160};  // how often the Ritz values are looked at
  constexpr double close_enough = 1e-4, exhausted = 1e-12;      // relative
  const ScaledLaplacian laplacian(system);
  const Eigen::VectorXd rows = laplacian.row_bounds();
  const double most = rows.size() > 0 ? rows.maxCoeff() : 0;
  if (!(most > 0) || !std::isfinite(most)) return std::sqrt(std::max(0.0, most));

  Eigen::VectorXd before = Eigen::VectorXd::Zero(rows.size()), present = laplacian_start(rows);
  std::vector<double> diagonal, coupling;
  for (std::size_t look = 0; look < looks.size();) {
    Eigen::VectorXd next = laplacian * present;
    diagonal.push_back(present.dot(next));
    next -= diagonal.back() * present;
    if (!coupling.empty()) next -= coupling.back() * before;
    coupling.push_back(next.norm());
    const bool ends = coupling.back() <= exhausted * most;
    if (ends || diagonal.size() == looks[look]) {
      const Spectrum found = ritz_extremes(diagonal, coupling, coupling.back());
      if (ends || ++look == looks.size() || found.largest_residual <= close_enough * found.largest)
        return std::sqrt(std::min(most, found.largest + found.largest_residual));
    }
    before = std::move(present);
    present = next / coupling.back();
  }
  return std::sqrt(most);
}

}  // namespace cloth
