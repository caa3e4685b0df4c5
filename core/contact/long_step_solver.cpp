#include "contact/long_step_solver.h"

#include <algorithm>

#include "integrators/integrator.h"

namespace cloth {

double largest_resistance(const ClothSystem& system, double weight) {
  const double stiffest = std::max(stiffest_of(system).spring, stiffest_edge(system.membrane));
  return stiffest + *std::max_element(system.mass.begin(), system.mass.end()) / (weight * weight);
}

void LongStepSolver::begin(ForceModel& forces, const LongStep& step, const Vec3Field& position) {
  if (step.rate) step.rate->begin(step.weight);
  integrated_position_ = position;
  forces.update(position, step.end);
  forces.force(position, step.velocity, integrated_force_);
}

void LongStepSolver::find_residual(const ClothSystem& system, ForceModel& forces, const LongStep& step,
                                   const Vec3Field& position, Vec3Field& residual) {
  residual = position;
  add_scaled(-1, integrated_position_, residual);
  velocity_ = step.velocity;
  add_scaled(1 / step.weight, residual, velocity_);
  forces.update(position, step.end);
  forces.force(position, velocity_, force_);
  if (step.rate) step.rate->add_force(position, force_);
  for (std::size_t i = 0; i < position.size(); ++i)
    residual.set(i, system.pinned[i] ? Vec3::Zero()
                                     : Vec3(system.mass[i] / (step.weight * step.weight) * residual[i] -
                                            (force_[i] - integrated_force_[i])));
  if (step.force) add_scaled(1, *step.force, residual);
}

Linearisation& LongStepSolver::linearise(const ClothSystem& system, ForceModel& forces, const LongStep& step,
                                         const Vec3Field& position) {
  const double weight = step.weight;
  const LinearisationWeights weights{.position = weight * weight, .velocity = weight, .clamped = true};
  method_ = choose_linear_method(system, weights).method;
  forces.linearise(position, weights, linearisation_);
  if (step.rate) step.rate->add_stiffness(position, linearisation_);
  return linearisation_;
}

bool LongStepSolver::solve(const ClothSystem& system, const Vec3Field& position,
                           const Vec3Field& right_hand_side, Vec3Field& solution) {
  constexpr double forcing = 0.01;
  if (method_ == LinearMethod::cholesky) {
    if (!factors_.factorise(system, linearisation_)) return false;
    factors_.solve(right_hand_side, solution);
    return true;
  }
  if (method_ == LinearMethod::multigrid && multigrid_.prepare(system, linearisation_, position)) {
    const LinearMap cycle = [this](const Vec3Field& in, Vec3Field& out) { multigrid_.precondition(in, out); };
    if (gradients_.solve(system, linearisation_, cycle, right_hand_side, forcing, solution).converged)
      return true;
  }
  jacobi_.prepare(system, linearisation_);
  return gradients_.solve(system, linearisation_, jacobi_, right_hand_side, forcing, solution).converged;
}

}  // namespace cloth
