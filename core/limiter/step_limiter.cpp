#include "limiter/step_limiter.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "cloth/sums.h"

namespace cloth {
namespace {

/// The kinetic energy that a change of velocities adds to a cloth whose velocity is `velocity` + share *
/// change when it comes: sum m change . (velocity + share change), J.
double work_of_changes(const ClothSystem& system, const Vec3Field& change, const Vec3Field& velocity,
                       double share) {
  const double* by[] = {change.x(), change.y(), change.z()};
  const double* v[] = {velocity.x(), velocity.y(), velocity.z()};
  double work = 0;
  for (int axis = 0; axis < 3; ++axis)
    work += ordered_sum(change.size(), [m = system.mass.data(), d = by[axis], u = v[axis], share](
                                           std::size_t k) { return m[k] * d[k] * (u[k] + share * d[k]); });
  return work;
}

double work_of_changes(const ClothSystem& system, const SparseField& change, const Vec3Field& velocity,
                       double share) {
  if (change.is_everywhere()) return work_of_changes(system, change.values(), velocity, share);
  double work = 0;
  for (const std::uint32_t i : change.particles())
    work += system.mass[i] * change[i].dot(velocity[i] + share * change[i]);
  return work;
}

std::span<double> all_of(Vec3Field& field) {
  return field.flat();
}
std::span<double> all_of(SparseField& field) {
  return field.everywhere().flat();
}

/// speed += (to - from) / time step, where particles have moved.
template <class Field>
void add_speed(const SparseField& from, const Vec3Field& to, double time_step, Field& speed) {
  if (!from.is_everywhere()) {
    for (const std::uint32_t i : from.particles()) speed.add(i, (to[i] - from[i]) / time_step);
    return;
  }
  const std::span<const double> before = from.values().flat(), after = to.flat();
  const std::span<double> all = all_of(speed);
  for (std::size_t k = 0; k < all.size(); ++k) all[k] += (after[k] - before[k]) / time_step;
}

}  // namespace

StepLimiter::StepLimiter(const Deformation& deformation, const ClothSystem& system, bool unreachable)
    : deformation_(deformation),
      system_(&system),
      mass_(system.total_mass()),
      limiter_(deformation, system, unreachable) {
  if (deformation.solver != "auto") return;
  tensions_.emplace(deformation, system, unreachable);
  tension_ = held_ = SpringTensions(tensions_->springs().size());
}

void StepLimiter::set_tension(const std::vector<double>& tension) {
  if (tension.size() == tension_.size())
    tension_ = SpringTensions(tension);
  else
    tension_.clear();
}

void StepLimiter::begin(double time_step) {
  time_step_ = time_step;
  report_ = {};
  work_ = 0;
  opened_ = changed_ = closed_ = false;
}

void StepLimiter::begin_step(double time_step, const ClothState& state, bool drifts_with_end_velocity) {
  begin(time_step);
  drifts_with_end_velocity_ = drifts_with_end_velocity;
  if (drifts_with_end_velocity) start_velocity_ = state.velocity;
}

bool StepLimiter::holds() const {
  return tension_.any() && !tensions_->unreachable();
}

/// Springs that are held lie side by side, so that they have some half as many ends.
bool StepLimiter::holds_few() const {
  return tension_.is_few() && tension_.held().size() <= static_cast<std::size_t>(system_->size()) / 12;
}

/// velocity and change += duration W J^T tension
void StepLimiter::pull(double duration, const SpringTensions& tension, SparseField& change,
                       ClothState& state) {
  pull_.clear(state.position.size());
  tensions_->add_force(tension, state.position, pull_);
  if (pull_.is_everywhere()) {
    add_acceleration(*system_, duration, pull_.values(), state.velocity);
    add_acceleration(*system_, duration, pull_.values(), change.everywhere());
    return;
  }
  for (const std::uint32_t i : pull_.particles()) {
    const Vec3 kick = duration * system_->inverse_mass[i] * pull_[i];
    state.velocity.add(i, kick), change.add(i, kick);
  }
}

void StepLimiter::before_kick(double kick, double drift, ClothState& state) {
  time_step_ = drift;
  start_velocity_ = state.velocity;
  opened_ = holds();
  if (!opened_) return;
  tensions_->hold(tension_, time_step_, held_);
  change_.clear(state.position.size());
  pull(kick, held_, change_, state);
}

/// Moves the positions to satisfy the rate and reports the rest. False: they did already.
bool StepLimiter::move(ClothState& state) {
  if (!tensions_ || !opened_) {
    report_.excess = limiter_.excess(state.position);
    if (tensions_) forget_tensions();
    const bool is_small = limiter_.accepts(report_.excess) &&
                          (!tensions_ || report_.excess == 0 || report_.excess <= target_residual(state));
    if (is_small) return false;
  }
  if (!tensions_) {
    drifted_.clear(state.position.size());
    drifted_.everywhere() = state.position;
    add_report(limiter_.apply(*system_, time_step_, state));
    return true;
  }
  if (opened_) tension_.copy(held_);
  const TensionReport found =
      tensions_->solve(*system_, time_step_, tension_, state.position, target_residual(state));
  add_report(
      {.sweeps = found.line_sweeps, .direct_iterations = found.factorisations, .excess = found.excess});
  add_speed(moved_from(), state.position, time_step_, state.velocity);
  return true;
}

/// The residual of a solve becomes velocity, residual/h. It must be small compared with the velocities of the
/// cloth, or it would add energy: short steps need a smaller residual than the tolerance.
double StepLimiter::target_residual(const ClothState& state) const {
  constexpr double of_speed = 0.01, least = 0.01;  // of the tolerance
  const double kinetic = work_of_changes(*system_, state.velocity, state.velocity, -0.5);
  const double speed = std::sqrt(2 * kinetic / mass_);
  const double small = of_speed * time_step_ * speed / tensions_->shortest();
  return std::clamp(small, least * deformation_.tolerance, deformation_.tolerance);
}

void StepLimiter::add_report(const LimiterReport& found) {
  report_.sweeps += found.sweeps, report_.direct_iterations += found.direct_iterations;
  report_.excess = found.excess;
}

/// The change of velocities by the last move.
void StepLimiter::find_change(const ClothState& state) {
  change_.clear(state.position.size());
  add_speed(moved_from(), state.position, time_step_, change_);
}

/// The work of the opening kick and of limiting is taken at the beginning of the step, that of the closing
/// kick at its end: Verlet then keeps its energy balance up to a term of order h^2 that oscillates and does
/// not grow. Where the drift uses the end velocity it is taken with the mean of the velocities at both ends,
/// for the same reason.
void StepLimiter::after_drift(double closing_kick, ClothState& state) {
  const bool moved = move(state);
  closing_kick_ = closing_kick;
  changed_ = moved || opened_;
  if (changed_) {
    if (!opened_) change_.clear(state.position.size());
    if (moved) add_speed(moved_from(), state.position, time_step_, change_);
    *work_ += closing_kick > 0 ? work_of_changes(*system_, change_, start_velocity_, 0.5)
                               : 0.5 * (work_of_changes(*system_, change_, start_velocity_, 0) +
                                        work_of_changes(*system_, change_, state.velocity, 0));
  }
  close(state);
}

void StepLimiter::close(ClothState& state) {
  closed_ = closing_kick_ > 0 && holds();
  if (!closed_) return;
  tensions_->hold(tension_, time_step_, held_);
  closing_.clear(state.position.size());
  pull(closing_kick_, held_, closing_, state);
}

void StepLimiter::forget_tensions() {
  tension_.clear();
}

void StepLimiter::end_step(const ClothState& state) {
  if (closed_) *work_ += work_of_changes(*system_, closing_, state.velocity, -0.5);
}

/// For methods that drift with their end velocity the work is taken as in after_drift(); for others it is the
/// change of the energy.
bool StepLimiter::after_step(ClothState& state) {
  if (!move(state)) return false;
  if (!drifts_with_end_velocity_) {
    work_.reset();
    return true;
  }
  find_change(state);
  work_ = 0.5 * (work_of_changes(*system_, change_, start_velocity_, 0) +
                 work_of_changes(*system_, change_, state.velocity, 0));
  return true;
}

/// In such a step springs have pulled at lengths that exceed the rate, so that the limited cloth would
/// rebound with more energy than it had. The change c of velocities is scaled by s, as near to 1 as s^2 sum m
/// c^2/2 + s sum m c . v + potential <= 0  allows, or where that is least.
void StepLimiter::limit_energy_gain(double potential, ClothState& state) {
  find_change(state);
  const Vec3Field none(change_.size());
  const double square = work_of_changes(*system_, change_, none, 0.5);
  const double linear = work_of_changes(*system_, change_, state.velocity, -1);
  if (!(square > 0) || square + linear + potential <= 0) return;
  const double least = -linear / (2 * square), radicand = linear * linear - 4 * square * potential;
  const double aside = radicand > 0 ? std::sqrt(radicand) / (2 * square) : 0;
  constexpr double max_share = 2;  // stops a load: dx/h removes half of its speed
  const double share = std::clamp(least + std::copysign(aside, 1 - least), 0.0, max_share);
  add_scaled(share - 1, change_, state.velocity);
}

void StepLimiter::limit_initial_shape(double time_step, ClothState& state) {
  begin(time_step);
  const Vec3Field velocity = state.velocity;
  move(state);
  state.velocity = velocity;
  set_tension({});
  report_ = {};
}

std::pair<int, int> StepLimiter::worst_spring(const Vec3Field& position) const {
  std::pair<int, int> worst{0, 0};
  double largest = -1;
  for (const TensionSpring& spring : tension_springs(deformation_, *system_)) {
    if (system_->pinned[spring.first] && system_->pinned[spring.second]) continue;
    const double excess = spring.excess(position);
    if (excess <= largest) continue;
    largest = excess;
    worst = {static_cast<int>(spring.first), static_cast<int>(spring.second)};
  }
  return worst;
}

}  // namespace cloth
