#include "integrators/projective.h"

#include <algorithm>
#include <cmath>

#include "integrators/largest_square.h"
#include "kernels/instruction_set.h"
#include "kernels/vector_kernels.h"

namespace cloth {
namespace {

NodeCoefficient sum_of(const NodeCoefficient& a, const NodeCoefficient& b) {
  return {a.each + b.each, a.per_mass + b.per_mass};
}

ProjectiveMatrix::Coefficients coefficients_of(const NodeDamping& parts, double h) {
  return {.step = h,
          .node_damping = sum_of(parts.isotropic, parts.along_normal.positive()),
          .spring_damping = parts.along_springs,
          .stretch_time = parts.stretch_time,
          .bending_time = parts.bending_time,
          .membrane_time = parts.membrane_time,
          .held_particle = parts.held_particle,
          .held_damping = parts.held_isotropic,
          .held_stiffness = parts.held_stiffness};
}

}  // namespace

/// r at the present velocity.
void Projective::find_residual(ForceModel& forces, const StepTimes& times, ClothState& state) {
  state.position = start_position_;
  add_scaled(times.step, state.velocity, state.position);
  find_step_residual(forces, times, start_velocity_, state, force_, residual_);
}

/// Returns the largest change of a particle's speed, relative to the largest speed.
double Projective::advance(bool may_accelerate, double merit, Vec3Field& velocity) {
  accelerated_ =
      may_accelerate && acceleration_->propose({velocity, residual_, correction_, merit}, proposal_);
  if (accelerated_) {
    plain_ = velocity;
    add_scaled(-1, correction_, plain_);
    correction_ = proposal_;
    add_scaled(-1, velocity, correction_);
    velocity = proposal_;
  } else {
    add_scaled(-1, correction_, velocity);
  }
  const double change = largest_square(correction_), largest = largest_square(velocity);
  return largest > 0 ? std::sqrt(change / largest) : 0;
}

void Projective::iterate(ForceModel& forces, const StepTimes& times, ClothState& state,
                         IntegratorReport& report) {
  const VectorKernels& vectors = active_kernels<VectorKernels>();
  double merit = 0;
  for (int n = 0; n < iterations_; ++n) {
    find_residual(forces, times, state);
    matrix_.solve(residual_, correction_);
    ++report.force_evaluations;
    ++report.iterations;
    if (!acceleration_) {
      report.residual = advance(false, 0, state.velocity);
      continue;
    }
    const double before = merit;
    merit = vectors.dot(residual_.x(), correction_.x(), 3 * residual_.size());
    if (accelerated_ && !(merit <= before)) {
      state.velocity = plain_, merit = before;
      accelerated_ = false;
      acceleration_->restart();
      continue;
    }
    report.residual = advance(n + 2 < iterations_, merit, state.velocity);
  }
}

IntegratorReport Projective::step(ForceModel& forces, const StepTimes& times, ClothState& state, Work& work) {
  IntegratorReport report;
  const ClothSystem& system = forces.system();
  const double h = times.step;
  if (force_.size() != state.position.size())
    force_ = residual_ = correction_ = Vec3Field(state.position.size());
  bool usable = true;
  report.factorisations = matrix_.prepare(system, coefficients_of(forces.damping_parts(), h), &usable);
  if (!usable) {
    report.failure = SolverFailure{0, "the constant matrix could not be factored"};
    return report;
  }

  start_position_ = state.position;
  start_velocity_ = state.velocity;
  accelerated_ = false;
  if (acceleration_) acceleration_->restart();
  if (std::any_of(system.inverse_mass.begin(), system.inverse_mass.end(), [](double w) { return w > 0; }))
    iterate(forces, times, state, report);
  state.position = start_position_;
  add_scaled(h, state.velocity, state.position);
  left_.note(start_velocity_, state);
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
