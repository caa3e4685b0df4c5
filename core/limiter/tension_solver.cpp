#include "limiter/tension_solver.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "cloth/sums.h"
#include "kernels/instruction_set.h"

namespace cloth {
namespace {

constexpr int max_tension_rounds = 100;
constexpr int max_rounds_to_aim = 10;  ///< within the tolerance already

/// Share of m l/h^2, the tension that rotates its spring by 1 rad within a step.
constexpr double held_share = 0.5;

/// Where the pins make the rate unreachable.
constexpr double soft_springs = 3e-2;

bool is_finite(const Vec3Field& field) {
  const double* x = field.flat().data();
  return ordered_sum(field.flat().size(), [x](std::size_t k) { return 0 * x[k]; }) == 0;
}

}  // namespace

TensionSolver::TensionSolver(const Deformation& deformation, const ClothSystem& system, bool unreachable)
    : deformation_(deformation),
      kernels_(&active_kernels<TensionKernels>()),
      springs_(tension_springs(deformation, system)),
      unreachable_(unreachable) {
  hold_.reserve(springs_.size());
  for (const TensionSpring& spring : springs_)
    shortest_ = shortest_ > 0 ? std::min(shortest_, spring.rest_length) : spring.rest_length;
  for (const TensionSpring& spring : springs_) {
    const double lighter = std::max(system.inverse_mass[spring.first], system.inverse_mass[spring.second]);
    hold_.push_back(lighter > 0 ? held_share * spring.limit / lighter : 0);
  }
  grid_ = plan_grid(springs_, system);
  rounds_ = make_tension_rounds(springs_, system);
}

void TensionSolver::add_force(const std::vector<double>& tension, const Vec3Field& position,
                              Vec3Field& force) const {
  if (grid_) return add_grid_force(tension, position, force);
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    if (!(tension[s] > 0)) continue;
    const std::size_t i = springs_[s].first, j = springs_[s].second;
    const Vec3 d = position[j] - position[i];
    const double length = d.norm();
    if (!(length > 0)) continue;
    const Vec3 pull = (tension[s] / length) * d;
    force.add(i, pull);
    force.add(j, -pull);
  }
}

/// Row by row; rows without a tension are skipped.
void TensionSolver::add_grid_force(const std::vector<double>& tension, const Vec3Field& position,
                                   Vec3Field& force) const {
  std::vector<double> scratch(3 * static_cast<std::size_t>(grid_->columns));
  for (const GridFamily& family : grid_->families) {
    const int width = family.width();
    const std::ptrdiff_t offset = family.down * grid_->columns + family.across;
    for (int row = 0; row < family.rows; ++row) {
      const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(row) * grid_->columns + family.begin;
      const double* t =
          tension.data() + family.first_spring + static_cast<std::ptrdiff_t>(row) * family.width();
      if (std::none_of(t, t + width, [](double pull) { return pull > 0; })) continue;
      kernels_->force_row(
          {position.x() + i, position.y() + i, position.z() + i, force.x() + i, force.y() + i, force.z() + i},
          offset, t, scratch.data(), width);
    }
  }
}

void TensionSolver::hold(const std::vector<double>& tension, double time_step,
                         std::vector<double>& held) const {
  held.assign(tension.size(), 0.0);
  if (unreachable_) return;
  const double per_square = 1 / (time_step * time_step);
  for (std::size_t s = 0; s < tension.size(); ++s) held[s] = std::min(tension[s], hold_[s] * per_square);
}

/// Rounds until the residual is small enough or the bound on rounds is reached.
void TensionSolver::run_rounds(const TensionTask& task, const ClothSystem& system,
                               std::vector<double>& tension, Vec3Field& position, TensionReport& report) {
  rounds_->begin(task, system.inverse_mass, tension, position);
  TensionResidual residual = rounds_->evaluate();
  int rounds = 0, rounds_to_aim = 0;
  while (!residual.within(task.tolerance) && rounds < max_tension_rounds) {
    if (residual.within(deformation_.tolerance) && ++rounds_to_aim > max_rounds_to_aim) break;
    rounds_->sweep_lines(rounds % 2 == 1);
    ++rounds, ++report.line_sweeps;
    residual = rounds_->evaluate();
    if (residual.within(task.tolerance)) break;
    report.cg_iterations += rounds_->solve_together();
    residual = rounds_->evaluate();
  }
  report.rounds += rounds;
  report.excess = residual.excess, report.slack = residual.slack;
  report.converged = residual.within(deformation_.tolerance);
  if (rounds > 0) rounds_->end(tension, position);
}

/// Replaces positions and tensions by the nearest shape to the positions without tensions, and its
/// multipliers.
void TensionSolver::restart_from_nearest(const TensionTask& task, const ClothSystem& system,
                                         std::vector<double>& tension, Vec3Field& position,
                                         TensionReport& report) {
  if (!nearest_) nearest_.emplace(deformation_, system);
  const double square = task.time_step * task.time_step;
  Vec3Field pull(position.size());
  add_force(tension, position, pull);
  for (std::size_t i = 0; i < position.size(); ++i)
    if (system.inverse_mass[i] > 0) position.add(i, -square * system.inverse_mass[i] * pull[i]);
  report.factorisations = nearest_->find(system, task.tolerance, position, !unreachable_).iterations;

  const double unit = system.total_mass() / system.size() / square;  // of a multiplier, N/m
  std::fill(tension.begin(), tension.end(), 0.0);
  std::size_t found = 0;
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const TensionSpring& spring = springs_[s];
    if (system.pinned[spring.first] && system.pinned[spring.second]) continue;
    const double slack = spring.limit - (position[spring.second] - position[spring.first]).norm();
    if (slack <= 0.5 * task.tolerance * spring.rest_length)
      tension[s] = unit * nearest_->multipliers()[found];
    ++found;
  }
}

/// Whether no spring of a grid has a tension or is over its limit: most steps of a slack cloth end here.
bool TensionSolver::is_inactive(const std::vector<double>& tension, Vec3Field& position) const {
  if (!grid_) return false;
  const double* t = tension.data();
  if (ordered_sum(tension.size(), [t](std::size_t s) { return t[s]; }) != 0) return false;
  const GridNodes nodes{position.x(), position.y(), position.z(), position.x()};  // weights are not used
  for (const GridFamily& family : grid_->families) {
    const std::ptrdiff_t offset = family.down * grid_->columns + family.across;
    for (int row = 0; row < family.rows; ++row) {
      const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(row) * grid_->columns + family.begin;
      const double longest = kernels_->measure_row(nodes, i, offset, t, family.width(), false).longest;
      if (!(longest <= family.limit * family.limit)) return false;
    }
  }
  return true;
}

TensionReport TensionSolver::solve(const ClothSystem& system, double time_step, std::vector<double>& tension,
                                   Vec3Field& position, double target_residual) {
  TensionReport report;
  if (!is_finite(position)) {
    report.excess = std::nan("");
    return report;
  }
  if (is_inactive(tension, position)) {
    report.converged = true;
    return report;
  }
  const TensionTask task{.time_step = time_step,
                         .tolerance = std::min(target_residual, deformation_.tolerance),
                         .softness = unreachable_ ? soft_springs : 0};
  start_ = position, first_ = tension;
  run_rounds(task, system, tension, position, report);
  if (!report.converged && !unreachable_) {
    position = start_, tension = first_;
    restart_from_nearest(task, system, tension, position, report);
    run_rounds(task, system, tension, position, report);
  }
  if (unreachable_) report.excess = excess(position);
  return report;
}

}  // namespace cloth
