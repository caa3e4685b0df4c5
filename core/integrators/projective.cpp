#include "integrators/projective.h"

#include <algorithm>
#include <cmath>

namespace cloth {

bool Projective::holds_for(const ClothSystem& system, const Coefficients& numbers) const {
  const Coefficients& held = coefficients_;
  return factored_ && held.step == numbers.step && held.node_damping == numbers.node_damping &&
         held.spring_damping == numbers.spring_damping && held.held_particle == numbers.held_particle &&
         held.held_damping == numbers.held_damping && held.held_stiffness == numbers.held_stiffness &&
         held.springs == system.springs && held.mass == system.mass && held.pinned == system.pinned;
}

Projective::Matrix Projective::assemble() const {
  const Coefficients& c = coefficients_;
  const double h = c.step;
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](int i, int j, double value) {
    const int row = row_[static_cast<std::size_t>(i)], column = row_[static_cast<std::size_t>(j)];
    if (row >= 0 && column >= 0) entries.emplace_back(row, column, value);
  };
  for (std::size_t i = 0; i < c.mass.size(); ++i) {
    const int particle = static_cast<int>(i);
    add(particle, particle, c.mass[i] + h * c.node_damping);
  }
  if (c.held_particle >= 0)
    add(c.held_particle, c.held_particle, h * c.held_damping + h * h * c.held_stiffness);
  for (const SpringRun& run : c.springs) {
    const double weight = h * c.spring_damping + h * h * run.stiffness;
    for (int i = run.first; i < run.first + run.count; ++i) {
      const int j = i + run.offset;
      add(i, i, weight), add(j, j, weight);
      add(i, j, -weight), add(j, i, -weight);
    }
  }
  const auto size = static_cast<Eigen::Index>(free_.size());
  Matrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

bool Projective::factor(const ClothSystem& system, Coefficients numbers) {
  const bool same_pattern =
      factored_ && coefficients_.pinned == system.pinned && coefficients_.springs == system.springs;
  numbers.springs = system.springs;
  numbers.mass = system.mass;
  numbers.pinned = system.pinned;
  coefficients_ = std::move(numbers);
  if (!same_pattern) {
    free_.clear();
    row_.assign(system.pinned.size(), -1);
    for (std::size_t i = 0; i < row_.size(); ++i) {
      if (system.pinned[i]) continue;
      row_[i] = static_cast<int>(free_.size());
      free_.push_back(static_cast<int>(i));
    }
    residual_.resize(static_cast<Eigen::Index>(free_.size()), 3);
  }
  factored_ = true;
  if (free_.empty()) return true;
  const Matrix matrix = assemble();
  if (!same_pattern) factors_.analyzePattern(matrix);
  factors_.factorize(matrix);
  return factored_ = factors_.info() == Eigen::Success;
}

/// residual_ <- (L L^T)^-1 residual_, its rows in the order of the factors: x, y and z side by side, so that
/// every entry of L is read once for the three.
void Projective::solve() {
  const Matrix& lower = factors_.matrixL().nestedExpression();  // column by column, the diagonal first
  const int *begin = lower.outerIndexPtr(), *row = lower.innerIndexPtr();
  const double* value = lower.valuePtr();
  double* r = residual_.data();
  const int size = static_cast<int>(free_.size());
  for (int j = 0; j < size; ++j) {
    double* of_j = r + 3 * j;
    for (int axis = 0; axis < 3; ++axis) of_j[axis] /= value[begin[j]];
    for (int k = begin[j] + 1; k < begin[j + 1]; ++k)
      for (int axis = 0; axis < 3; ++axis) r[3 * row[k] + axis] -= value[k] * of_j[axis];
  }
  for (int j = size - 1; j >= 0; --j) {
    double* of_j = r + 3 * j;
    for (int k = begin[j] + 1; k < begin[j + 1]; ++k)
      for (int axis = 0; axis < 3; ++axis) of_j[axis] -= value[k] * r[3 * row[k] + axis];
    for (int axis = 0; axis < 3; ++axis) of_j[axis] /= value[begin[j]];
  }
}

/// velocity -= A^-1 r; returns the largest change of a particle's speed, relative to the largest speed.
double Projective::correct(const ClothSystem& system, const Vec3Field& start_velocity, double h,
                           Vec3Field& velocity) {
  const auto& order = factors_.permutationP().indices();
  const auto place = [&](std::size_t row) { return order[static_cast<Eigen::Index>(row)]; };
  for (std::size_t row = 0; row < free_.size(); ++row) {
    const auto i = static_cast<std::size_t>(free_[row]);
    residual_.row(place(row)) = system.mass[i] * (velocity[i] - start_velocity[i]) - h * force_[i];
  }
  solve();
  double change = 0, largest = 0;
  for (std::size_t row = 0; row < free_.size(); ++row) {
    const auto i = static_cast<std::size_t>(free_[row]);
    const Vec3 correction = residual_.row(place(row));
    velocity.add(i, -correction);
    change = std::max(change, correction.squaredNorm());
    largest = std::max(largest, velocity[i].squaredNorm());
  }
  return largest > 0 ? std::sqrt(change / largest) : 0;
}

IntegratorReport Projective::step(const ClothSystem& system, ForceModel& forces, const StepTimes& times,
                                  ClothState& state, Work& work) {
  IntegratorReport report;
  const double h = times.step;
  if (force_.size() != state.position.size()) force_ = Vec3Field(state.position.size());

  const NodeDamping parts = forces.damping_parts();
  const Coefficients numbers{.step = h,
                             .node_damping = parts.isotropic + parts.along_normal,
                             .spring_damping = parts.along_springs,
                             .held_particle = parts.held_particle,
                             .held_damping = parts.held_isotropic,
                             .held_stiffness = parts.held_stiffness,
                             .springs = {},
                             .mass = {},
                             .pinned = {}};
  if (!holds_for(system, numbers)) {
    ++report.factorisations;
    if (!factor(system, numbers)) {
      report.failure = SolverFailure{0, "the constant matrix could not be factored"};
      return report;
    }
  }

  start_position_ = state.position;
  start_velocity_ = state.velocity;
  add_scaled(h, state.velocity, state.position);
  for (int n = 0; n < iterations_ && !free_.empty(); ++n) {
    forces.update(state.position, times.end);
    forces.force(state.velocity, force_);
    report.residual = correct(system, start_velocity_, h, state.velocity);
    state.position = start_position_;
    add_scaled(h, state.velocity, state.position);
    ++report.force_evaluations;
    ++report.iterations;
  }
  if (forces.has_power()) {
    forces.update(state.position, times.end);
    ++report.force_evaluations;
    work += h * forces.power(state.velocity);
  }
  return report;
}

}  // namespace cloth
