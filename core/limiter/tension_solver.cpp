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
/// Of springs one by one on a grid: nearly always some two, up to ten.
constexpr int most_rounds_of_few = 20;

/// Share of m l/h^2, the tension that rotates its spring by 1 rad within a step.
constexpr double held_share = 0.5;

/// Where the pins make the rate unreachable.
constexpr double soft_springs = 3e-2;

/// Calls visit(particle, force on it) for both ends of each spring that has a tension.
template <class Visit>
void each_pull(const std::vector<TensionSpring>& springs, const SpringTensions& tension,
               const Vec3Field& position, const Visit& visit) {
  const auto pull_ends = [&](std::size_t s) {
    const std::size_t i = springs[s].first, j = springs[s].second;
    const Vec3 d = position[j] - position[i];
    const double length = d.norm();
    if (!(length > 0)) return;
    const Vec3 pull = (tension[s] / length) * d;
    visit(i, pull), visit(j, -pull);
  };
  if (tension.is_few())
    for (const std::uint32_t s : tension.held()) pull_ends(s);
  else
    for (std::size_t s = 0; s < springs.size(); ++s)
      if (tension[s] > 0) pull_ends(s);
}

/// `from` becomes where all particles were, of which it tells those that have moved.
void tell_all(const Vec3Field& position, SparseField& from) {
  if (from.is_everywhere()) return;
  Vec3Field all = position;
  for (const std::uint32_t i : from.particles()) all.set(i, from[i]);
  from.everywhere() = all;
}

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
}

void TensionSolver::add_force(const SpringTensions& tension, const Vec3Field& position,
                              Vec3Field& force) const {
  if (grid_ && !tension.is_few()) return add_grid_force(tension.values(), position, force);
  each_pull(springs_, tension, position, [&](std::size_t i, const Vec3& pull) { force.add(i, pull); });
}

void TensionSolver::add_force(const SpringTensions& tension, const Vec3Field& position,
                              SparseField& force) const {
  if (!tension.is_few()) return add_force(tension, position, force.everywhere());
  each_pull(springs_, tension, position, [&](std::size_t i, const Vec3& pull) { force.add(i, pull); });
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

void TensionSolver::hold(const SpringTensions& tension, double time_step, SpringTensions& held) const {
  if (unreachable_) return held.clear();
  const double per_square = 1 / (time_step * time_step);
  held.copy(tension);
  held.lower([&](std::size_t s) { return hold_[s] * per_square; });
}

/// Rounds until the residual is small enough or the bound on rounds is reached.
void TensionSolver::run_rounds(const TensionTask& task, bool by_lines, const ClothSystem& system,
                               SpringTensions& tension, Vec3Field& position, TensionReport& report) {
  TensionRounds& rounds = rounds_for(by_lines, system);
  rounds.begin(task, {system.inverse_mass, tension, position, from_, over_});
  TensionResidual residual = rounds.evaluate();
  int count = 0, rounds_to_aim = 0;
  while (!residual.within(task.tolerance) && count < max_tension_rounds) {
    if (by_lines && grid_ && (rounds.have_outgrown() || count >= most_rounds_of_few)) {
      rounds.end(true);
      report.rounds += count;
      tell_all(position, from_);
      return run_rounds(task, false, system, tension, position, report);
    }
    if (residual.within(deformation_.tolerance) && ++rounds_to_aim > max_rounds_to_aim) break;
    rounds.sweep_lines(count % 2 == 1);
    ++count, ++report.line_sweeps;
    residual = rounds.evaluate();
    if (residual.within(task.tolerance)) break;
    report.cg_iterations += rounds.solve_together();
    residual = rounds.evaluate();
  }
  report.rounds += count;
  report.excess = residual.excess, report.slack = residual.slack;
  report.converged = residual.within(deformation_.tolerance);
  rounds.end(count > 0);
}

/// Replaces positions and tensions by the nearest shape to the positions without tensions, and its
/// multipliers.
void TensionSolver::restart_from_nearest(const TensionTask& task, const ClothSystem& system,
                                         SpringTensions& tension, Vec3Field& position,
                                         TensionReport& report) {
  if (!nearest_) nearest_.emplace(deformation_, system);
  const double square = task.time_step * task.time_step;
  Vec3Field pull(position.size());
  add_force(tension, position, pull);
  for (std::size_t i = 0; i < position.size(); ++i)
    if (system.inverse_mass[i] > 0) position.add(i, -square * system.inverse_mass[i] * pull[i]);
  report.factorisations = nearest_->find(system, task.tolerance, position, !unreachable_).iterations;

  const double unit = system.total_mass() / system.size() / square;  // of a multiplier, N/m
  std::vector<double>& values = tension.write();
  std::fill(values.begin(), values.end(), 0.0);
  std::size_t found = 0;
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const TensionSpring& spring = springs_[s];
    if (system.pinned[spring.first] && system.pinned[spring.second]) continue;
    const double slack = spring.limit - (position[spring.second] - position[spring.first]).norm();
    if (slack <= 0.5 * task.tolerance * spring.rest_length) values[s] = unit * nearest_->multipliers()[found];
    ++found;
  }
  tension.list_held();
}

/// Finds over_; of a grid no more after it has more than `most`.
void TensionSolver::find_over(const SpringTensions& tension, Vec3Field& position, std::size_t most) {
  over_.clear();
  if (!grid_) {
    for (std::size_t s = 0; s < springs_.size(); ++s)
      if (springs_[s].excess(position) > 0 && hold_[s] > 0) over_.push_back(static_cast<std::uint32_t>(s));
    return;
  }
  for (const GridFamily& family : grid_->families)
    for (int row = 0; row < family.rows && over_.size() <= most; ++row)
      find_over_of_row(family, row, tension.values(), position);
}

/// Looks at single springs only where the longest is over the limit. Those between two pins have no hold_.
void TensionSolver::find_over_of_row(const GridFamily& family, int row, const std::vector<double>& tension,
                                     Vec3Field& position) {
  const GridNodes nodes{position.x(), position.y(), position.z(), position.x()};  // weights are not used
  const std::ptrdiff_t offset = family.down * grid_->columns + family.across,
                       i = static_cast<std::ptrdiff_t>(row) * grid_->columns + family.begin;
  const auto width = static_cast<std::size_t>(family.width());
  const std::size_t first = family.first_spring + static_cast<std::size_t>(row) * width;
  const double square = family.limit * family.limit;
  if (kernels_->measure_row(nodes, i, offset, tension.data() + first, family.width(), false).longest <=
      square)
    return;
  for (std::size_t s = first; s < first + width; ++s) {
    const Vec3 d = position[springs_[s].second] - position[springs_[s].first];
    if (d.squaredNorm() > square && hold_[s] > 0) over_.push_back(static_cast<std::uint32_t>(s));
  }
}

TensionRounds& TensionSolver::rounds_for(bool by_lines, const ClothSystem& system) {
  std::unique_ptr<TensionRounds>& rounds = by_lines ? line_rounds_ : grid_rounds_;
  if (!rounds) rounds = by_lines ? make_line_rounds(springs_, system) : make_grid_rounds(*grid_);
  return *rounds;
}

TensionReport TensionSolver::solve(const ClothSystem& system, double time_step, SpringTensions& tension,
                                   Vec3Field& position, double target_residual) {
  TensionReport report;
  from_.clear(position.size());
  if (!is_finite(position)) {
    report.excess = std::nan("");
    return report;
  }
  const std::size_t most = SpringTensions::most(springs_.size());
  over_.clear();
  if (!grid_ || tension.is_few()) find_over(tension, position, most);
  if (over_.empty() && !tension.any()) {
    report.converged = true;
    return report;
  }
  const TensionTask task{.time_step = time_step,
                         .tolerance = std::min(target_residual, deformation_.tolerance),
                         .softness = unreachable_ ? soft_springs : 0};
  const bool by_lines = !grid_ || (tension.is_few() && tension.held().size() + over_.size() <= most);
  first_.copy(tension);
  run_rounds(task, by_lines, system, tension, position, report);
  if (!report.converged && !unreachable_) {
    tell_all(position, from_);
    position = from_.values();
    tension.copy(first_);
    restart_from_nearest(task, system, tension, position, report);
    if (!grid_) find_over(tension, position, most);
    run_rounds(task, !grid_, system, tension, position, report);
  }
  if (unreachable_) report.excess = excess(position);
  return report;
}

}  // namespace cloth
