#include "integrators/projective.h"

#include <algorithm>
#include <cmath>

#include "geometry/at.h"

namespace cloth {
namespace {

NodeCoefficient sum_of(const NodeCoefficient& a, const NodeCoefficient& b) {
  return {a.each + b.each, a.per_mass + b.per_mass};
}

}  // namespace

bool Projective::factorise(const ClothSystem& system, const Coefficients& c) {
  if (!factored_ || pinned_ != system.pinned || springs_ != system.springs || bending_ != system.bending ||
      membrane_ != system.membrane || sliders_ != system.sliders) {
    rows_ = analyse_free_rows(system, factors_);
    residual_.resize(3 * rows_.particle.size());
  }
  coefficients_ = c, springs_ = system.springs, bending_ = system.bending, membrane_ = system.membrane,
  sliders_ = system.sliders,  mass_ = system.mass, pinned_ = system.pinned;

  const double h = c.step;
  std::vector<double> diagonal(rows_.particle.size()), off_diagonal;
  const auto add = [&](std::size_t particle, double value) {
    if (const int row = rows_.row[particle]; row >= 0) diagonal[at(row)] += value;
  };
  for (const int i : rows_.particle) add(at(i), mass_[at(i)] + h * c.node_damping.of(mass_[at(i)]));
  if (c.held_particle >= 0) add(at(c.held_particle), h * c.held_damping + h * h * c.held_stiffness);
  const auto couple = [&](std::size_t i, std::size_t j, double weight) {
    add(i, weight), add(j, weight);
    if (rows_.row[i] >= 0 && rows_.row[j] >= 0) off_diagonal.push_back(-weight);
  };
  for_each_spring(springs_, [&](const SpringRun& run, std::size_t, std::size_t i, std::size_t j) {
    couple(i, j, h * c.spring_damping + h * (h + c.stretch_time) * run.stiffness);
  });
  for_each_bending_pair(bending_, [&](std::size_t i, std::size_t j, double stiffness) {
    couple(i, j, h * (h + c.bending_time) * stiffness);
  });
  for_each_slider_pair(sliders_, [&](std::size_t i, std::size_t j, double stiffness) {
    couple(i, j, h * h * stiffness);
  });
  for (const MembraneTriangle& t : membrane_) {
    const std::array<double, 3> bound = edge_bounds(t);
    for (std::size_t e = 0; e < 3; ++e)
      couple(at(t.corner[e]), at(t.corner[(e + 1) % 3]), h * (h + c.membrane_time) * bound[e]);
  }
  return factored_ = factors_.factorise(diagonal, off_diagonal);
}

/// velocity -= A^-1 r; returns the largest change of a particle's speed, relative to the largest speed.
double Projective::correct(const ClothSystem& system, const Vec3Field& start_velocity, double h,
                           Vec3Field& velocity) {
  const std::size_t size = rows_.particle.size();
  double *x = residual_.data(), *y = x + size, *z = y + size;
  for (std::size_t row = 0; row < size; ++row) {
    const std::size_t i = at(rows_.particle[row]);
    const Vec3 r = system.mass[i] * (velocity[i] - start_velocity[i]) - h * force_[i];
    x[row] = r.x(), y[row] = r.y(), z[row] = r.z();
  }
  factors_.solve(residual_, 3);
  double change = 0, largest = 0;
  for (std::size_t row = 0; row < size; ++row) {
    const std::size_t i = at(rows_.particle[row]);
    const Vec3 correction(x[row], y[row], z[row]);
    velocity.add(i, -correction);
    change = std::max(change, correction.squaredNorm());
    largest = std::max(largest, velocity[i].squaredNorm());
  }
  return largest > 0 ? std::sqrt(change / largest) : 0;
}

IntegratorReport Projective::step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) {
  IntegratorReport report;
  const ClothSystem& system = forces.system();
  const double h = times.step;
  if (force_.size() != state.position.size()) force_ = Vec3Field(state.position.size());

  const NodeDamping parts = forces.damping_parts();
  const Coefficients numbers{.step = h,
                             .node_damping = sum_of(parts.isotropic, parts.along_normal.positive()),
                             .spring_damping = parts.along_springs,
                             .stretch_time = parts.stretch_time,
                             .bending_time = parts.bending_time,
                             .membrane_time = parts.membrane_time,
                             .held_particle = parts.held_particle,
                             .held_damping = parts.held_isotropic,
                             .held_stiffness = parts.held_stiffness};
  if (!factored_ || coefficients_ != numbers || springs_ != system.springs || bending_ != system.bending ||
      membrane_ != system.membrane || sliders_ != system.sliders || mass_ != system.mass || pinned_ != system.pinned) {
    ++report.factorisations;
    if (!factorise(system, numbers)) {
      report.failure = SolverFailure{0, "the constant matrix could not be factored"};
      return report;
    }
  }

  start_position_ = state.position;
  start_velocity_ = state.velocity;
  add_scaled(h, state.velocity, state.position);
  for (int n = 0; n < iterations_ && !rows_.particle.empty(); ++n) {
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
