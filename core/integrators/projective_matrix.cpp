#include "integrators/projective_matrix.h"

#include <cmath>

#include "geometry/at.h"

namespace cloth {

bool ProjectiveMatrix::has_pattern_of(const ClothSystem& system) const {
  return pinned_ == system.pinned && springs_ == system.springs && bending_ == system.bending &&
         membrane_ == system.membrane && sliders_ == system.sliders;
}

bool ProjectiveMatrix::is_of(const ClothSystem& system, const Coefficients& numbers) const {
  return usable_ && coefficients_ == numbers && mass_ == system.mass && has_pattern_of(system);
}

/// add(i, value) for what belongs to the diagonal, couple(i, j, weight) for springs between two particles:
/// weight belongs to the diagonal of both and, with a minus, beside it.
template <class Add, class Couple>
void ProjectiveMatrix::for_each_number(Add add, Couple couple) const {
  const Coefficients& c = coefficients_;
  const double h = c.step;
  for (std::size_t i = 0; i < mass_.size(); ++i)
    if (!pinned_[i]) add(i, mass_[i] + h * c.node_damping.of(mass_[i]));
  if (c.held_particle >= 0) add(at(c.held_particle), h * c.held_damping + h * h * c.held_stiffness);
  for_each_spring(springs_, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
    couple(i, j, h * c.spring_damping + h * (h + c.stretch_time) * run.stiffness);
  });
  for_each_bending_pair(bending_rows_, bending_, [&](std::size_t i, std::size_t j, double stiffness) {
    couple(i, j, h * (h + c.bending_time) * stiffness);
  });
  for_each_slider_pair(
      sliders_, [&](std::size_t i, std::size_t j, double stiffness) { couple(i, j, h * h * stiffness); });
  for (const MembraneTriangle& t : membrane_) {
    const std::array<double, 3> bound = edge_bounds(t);
    for (std::size_t e = 0; e < 3; ++e)
      couple(at(t.corner[e]), at(t.corner[(e + 1) % 3]), h * (h + c.membrane_time) * bound[e]);
  }
}

int ProjectiveMatrix::prepare(const ClothSystem& system, const Coefficients& numbers, bool* usable) {
  *usable = true;
  if (is_of(system, numbers)) return 0;
  const bool same_pattern = analysed_ && has_pattern_of(system);
  coefficients_ = numbers, springs_ = system.springs, bending_ = system.bending;
  bending_rows_ = system.bending_rows;
  membrane_ = system.membrane, sliders_ = system.sliders, mass_ = system.mass, pinned_ = system.pinned;
  const bool is_grid = !system.is_mesh() && system.rows > 1 && system.columns > 1;
  grid_rows_ = is_grid ? system.rows : 0, grid_columns_ = is_grid ? system.columns : 0;
  factor_.reset();
  cycles_ = mass_.size() >= fewest_particles && prepare_cycles();
  usable_ = cycles_ || factorise(same_pattern, system);
  *usable = usable_;
  return 1;
}

bool ProjectiveMatrix::prepare_cycles() {
  if (grid_rows_ == 0) return false;
  GridStencils stencils(grid_rows_, grid_columns_);
  bool fits = true;
  const auto add = [&](std::size_t i, double value) {
    if (!pinned_[i]) stencils.add_to_diagonal(i, value);
  };
  for_each_number(add, [&](std::size_t i, std::size_t j, double weight) {
    add(i, weight), add(j, weight);
    if (!pinned_[i] && !pinned_[j]) fits = fits && stencils.add_coupling(i, j, -weight);
  });
  if (!fits || !multigrid_.prepare(std::move(stencils))) return false;
  factor_ = multigrid_.convergence_factor();
  return *factor_ <= largest_factor;
}

bool ProjectiveMatrix::factorise(bool same_pattern, const ClothSystem& system) {
  if (!same_pattern) {
    rows_ = free_rows(system);
    analyse_free_rows(system, rows_, factors_);
  }
  analysed_ = true;
  values_.resize(3 * rows_.particle.size());
  std::vector<double> diagonal(rows_.particle.size()), off_diagonal;
  const auto add = [&](std::size_t particle, double value) {
    if (const int row = rows_.row[particle]; row >= 0) diagonal[at(row)] += value;
  };
  for_each_number(add, [&](std::size_t i, std::size_t j, double weight) {
    add(i, weight), add(j, weight);
    if (rows_.row[i] >= 0 && rows_.row[j] >= 0) off_diagonal.push_back(-weight);
  });
  return factors_.factorise(diagonal, off_diagonal);
}

void ProjectiveMatrix::solve(const Vec3Field& residual, Vec3Field& correction) {
  if (cycles_) return multigrid_.solve(residual, correction);
  const std::size_t size = rows_.particle.size();
  double *x = values_.data(), *y = x + size, *z = y + size;
  for (std::size_t row = 0; row < size; ++row) {
    const Vec3 r = residual[at(rows_.particle[row])];
    x[row] = r.x(), y[row] = r.y(), z[row] = r.z();
  }
  factors_.solve(values_, 3);
  correction.fill(0);
  for (std::size_t row = 0; row < size; ++row)
    correction.set(at(rows_.particle[row]), Vec3(x[row], y[row], z[row]));
}

}  // namespace cloth
