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

void Projective::analyse(const ClothSystem& system) {
  const Coefficients& c = coefficients_;
  free_.clear();
  row_.assign(c.pinned.size(), -1);
  for (std::size_t i = 0; i < row_.size(); ++i) {
    if (c.pinned[i]) continue;
    row_[i] = static_cast<int>(free_.size());
    free_.push_back(static_cast<int>(i));
  }
  residual_.resize(3 * free_.size());

  std::vector<Coupling> couplings;
  for (const SpringRun& run : c.springs) {
    for (int i = run.first; i < run.first + run.count; ++i) {
      const int a = row_[static_cast<std::size_t>(i)], b = row_[static_cast<std::size_t>(i + run.offset)];
      if (a >= 0 && b >= 0) couplings.emplace_back(a, b);
    }
  }
  std::vector<int> order = elimination_order(system);
  for (int& particle : order) particle = row_[static_cast<std::size_t>(particle)];
  factors_.analyse(couplings, order);
}

bool Projective::factorise() {
  const Coefficients& c = coefficients_;
  const double h = c.step;
  std::vector<double> diagonal(free_.size()), off_diagonal;
  const auto add = [&](int particle, double value) {
    if (const int row = row_[static_cast<std::size_t>(particle)]; row >= 0)
      diagonal[static_cast<std::size_t>(row)] += value;
  };
  for (const int i : free_) add(i, c.mass[static_cast<std::size_t>(i)] + h * c.node_damping);
  if (c.held_particle >= 0) add(c.held_particle, h * c.held_damping + h * h * c.held_stiffness);
  for (const SpringRun& run : c.springs) {
    const double weight = h * c.spring_damping + h * h * run.stiffness;
    for (int i = run.first; i < run.first + run.count; ++i) {
      const int j = i + run.offset;
      add(i, weight), add(j, weight);
      if (row_[static_cast<std::size_t>(i)] >= 0 && row_[static_cast<std::size_t>(j)] >= 0)
        off_diagonal.push_back(-weight);
    }
  }
  return factors_.factorise(diagonal, off_diagonal);
}

bool Projective::factor(const ClothSystem& system, Coefficients numbers) {
  const bool same_pattern =
      factored_ && coefficients_.pinned == system.pinned && coefficients_.springs == system.springs;
  numbers.springs = system.springs;
  numbers.mass = system.mass;
  numbers.pinned = system.pinned;
  coefficients_ = std::move(numbers);
  if (!same_pattern) analyse(system);
  return factored_ = factorise();
}

/// velocity -= A^-1 r; returns the largest change of a particle's speed, relative to the largest speed.
double Projective::correct(const ClothSystem& system, const Vec3Field& start_velocity, double h,
                           Vec3Field& velocity) {
  const std::size_t size = free_.size();
  double *x = residual_.data(), *y = x + size, *z = y + size;
  for (std::size_t row = 0; row < size; ++row) {
    const auto i = static_cast<std::size_t>(free_[row]);
    const Vec3 r = system.mass[i] * (velocity[i] - start_velocity[i]) - h * force_[i];
    x[row] = r.x(), y[row] = r.y(), z[row] = r.z();
  }
  factors_.solve(residual_, 3);
  double change = 0, largest = 0;
  for (std::size_t row = 0; row < size; ++row) {
    const auto i = static_cast<std::size_t>(free_[row]);
    const Vec3 correction(x[row], y[row], z[row]);
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
                             .node_damping = parts.isotropic + std::max(parts.along_normal, 0.0),
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
    forces.force(state.position, state.velocity, force_);
    report.residual = correct(system, start_velocity_, h, state.velocity);
    state.position = start_position_;
    add_scaled(h, state.velocity, state.position);
    ++report.force_evaluations;
    ++report.iterations;
  }
  if (forces.has_power()) {
    forces.update(state.position, times.end);
    ++report.force_evaluations;
    end_power_ = forces.power(state.position, state.velocity);
    end_weight_ = h;
    work += end_weight_ * end_power_;
  }
  return report;
}

}  // namespace cloth
