// How continuous contact moves cloth and obstacles through a step: substeps, and rounds within each of them.
#include <algorithm>
#include <utility>

#include "contact/continuous_contact.h"
#include "contact/obstacle_body.h"
#include "contact/particle_motion.h"

namespace cloth {
namespace {

constexpr int max_rounds_at_rest = 100, max_rounds_stuck = 15;
/// Rounds in which the longest remaining displacement does not decrease, after which the remaining particles
/// are held back.
constexpr int max_rounds_idle = 6;
constexpr double progress_part = 0.7;

/// Bound on the pairs and particles that the rounds of one step may visit: some seconds of work. Counted
/// instead of timed, so that a run does not depend on the machine.
double max_operations(std::size_t particles) {
  constexpr double least = 1e7, for_a_particle = 2e3;
  return least + for_a_particle * static_cast<double>(particles);
}

}  // namespace

void ContinuousContact::begin(const StepTimes& times) {
  set_thickness(times.end);
  starts_before_ = starts_;
  paths_.clear();
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    poses_[k] = starts_[k];
    end_poses_[k] = pose_in_transition(obstacles_, transitions_, k, times.end);
    const Obstacle& obstacle = obstacles_[k];
    const Vec3 spun = obstacle.keyframes.empty() ? Vec3(times.step * obstacle.spin) : Vec3(Vec3::Zero());
    paths_.emplace_back(bodies_[k].pivot, poses_[k], end_poses_[k], spun);
  }
  starts_ = end_poses_;
  part_ = note_still() ? 1 : 0;
  free_contains_contacts_ = false;
  radius_scale_.assign(position_.size(), 1.0);
  touches_.clear(), loaded_.clear(), force_work_.reset(), rate_work_ = 0;
  substep_ = 0, operation_count_ = 0, has_moved_ = false;
  substeps_ = substeps_for(bodies_, paths_, mean_edge_);
  if (substeps_ > 1) whole_paths_ = paths_;
}

/// Which obstacles do not move on the present paths; whether none does.
bool ContinuousContact::note_still() {
  is_still_.clear();
  for (const PoseInterpolation& path : paths_) is_still_.push_back(path.is_still());
  return std::find(is_still_.begin(), is_still_.end(), 0) == is_still_.end();
}

/// Whether anything can come near in a step of several substeps, by bounding boxes.
bool ContinuousContact::may_come_near() const {
  if (full_self_thickness_ > 0) return true;
  Bounds cloth;
  for (std::size_t i = 0; i < position_.size(); ++i)
    cloth.add(bounds_of(Vec3(position_[i]), Vec3(target_position_[i])));
  for (std::size_t k = 0; k < bodies_.size(); ++k)
    if (comes_near(bodies_[k], whole_paths_[k], cloth, thickness_)) return true;
  return false;
}

/// The target moves by an even share of the integrator's displacement, from the last substep's target.
void ContinuousContact::begin_substep(std::int64_t substep, const Vec3Field& from,
                                      const Vec3Field& integrated) {
  substep_ = substep;
  const double share = 1 / static_cast<double>(substeps_);
  if (substep == 0) target_position_ = from;
  for (std::size_t i = 0; i < position_.size(); ++i)
    target_position_.add(i, share * (integrated[i] - from[i]));
  free_position_ = target_position_;
  free_contains_contacts_ = free_contains_contacts_ || substep > 0;
  substep_from_ = position_;
  radius_scale_.assign(position_.size(), 1.0);
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    end_poses_[k] =
        whole_paths_[k].at(substep + 1 == substeps_ ? 1 : share * static_cast<double>(substep + 1));
    paths_[k] = PoseInterpolation(bodies_[k].pivot, poses_[k], end_poses_[k]);
  }
  part_ = note_still() ? 1 : 0;
  find_pairs();
}

/// Whether anything is near enough in this step for contact to have work. A state that is not finite is left
/// as it is: the run stops there.
bool ContinuousContact::is_near(const ContactStep& step, const ClothState& state) {
  if (!are_finite(state.position) || !are_finite(state.velocity)) return false;
  copy(state.position, team_, free_position_);
  copy(state.position, team_, target_position_);
  copy(step.position_before, team_, position_);
  begin(step.times);
  return substeps_ == 1 ? find_pairs() : may_come_near();
}

/// Leads the state to the solution of the step with the pairs' constraints, with the planes that separate
/// them as the step begins, and within the deformation rate; the rounds begin from there. Returns whether
/// there was anything to solve.
bool ContinuousContact::solve_long_step(const ContactStep& step, ClothState& state) {
  constraints_.clear();
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    ContactConstraint& contact =
        constraints_.emplace_back(constraint_of(k, step.system, step.position_before));
    contact.bound =
        std::min(contact.bound, contact.normal.dot(contact.rest));  // rounds separate what is nearer
    const Separation& s = separations_[k];
    const bool is_beside =
        s.distance < near_factor * memory_[k].thickness && !is_contact(s, memory_[k].thickness);
    if (is_beside || contact.normal.isZero(0)) contact.mobility = 0;  // no contact
  }
  // What gravity alone adds in a step is a load at rest, which friction of positions holds.
  constexpr double above_fall = 1.01;
  const double accepted =
      std::max(arrived_length(), above_fall * gravity_ * step.times.step * step.times.step);
  if (StiffTarget::largest_violation(constraints_, target_position_) <= accepted) return false;
  const LongStep whole{step.integrator.last_stage_weight() * step.times.step,
                       step.times.end,
                       step.position_before,
                       state.velocity,
                       step.integrator.force_left(step.forces, step.times),
                       step.limit ? &*rate_ : nullptr};
  if (!stiff_target_.solve(step.system, step.forces, constraints_, whole, accepted, target_position_))
    return false;
  approach_position_ = state.position;
  for (std::size_t i = 0; i < position_.size(); ++i)
    state.velocity.add(i, (target_position_[i] - state.position[i]) / whole.weight);
  state.position = free_position_ = target_position_;
  force_work_ = step.integrator.correct_work(step.forces, step.times, state);
  if (whole.rate) rate_work_ = whole.weight * rate_->power(state.position, state.velocity);
  for (std::size_t c = 0; c < constraints_.size(); ++c) {
    if (!(stiff_target_.loads()[c] > 0)) continue;
    Touch& touch = loaded_.emplace_back();
    touch.contact = constraints_[c];
    touch.contact.friction = friction_of(pairs_[c]);
    touch.obstacle = pairs_[c].obstacle;
    touch.contact.normal_impulse = step.times.step * whole.weight * stiff_target_.loads()[c];
    touch.contact.friction_impulse.setZero();
    touch.velocity = velocity_of_far_side(c, step.times.step);
  }
  find_pairs();
  return true;
}

/// Their impulses become estimates for the velocity solve, so that friction has them, and not a part of the
/// velocities that it begins with.
void ContinuousContact::take_loads(const ContactStep& step, ClothState& state) {
  for (const Touch& touch : loaded_) {
    ContactConstraint taken = touch.on_velocities(step.times.step);
    taken.normal_impulse = -taken.normal_impulse;
    apply_impulses(taken, step.system.inverse_mass, state.velocity);
    touches_.push_back(touch);
  }
}

ContactReport ContinuousContact::resolve(const ContactStep& step, ClothState& state) {
  team_ = job_.begin();
  close_pairs_.set_team(team_), solver_.set_team(team_);
  ContactReport report;
  bool near = is_near(step, state);
  const auto solves = [&] { return near && long_steps_ && substeps_ == 1; };
  if (!(solves() && solve_long_step(step, state)) && step.limit && step.limit()) {
    starts_ = starts_before_;
    near = is_near(step, state);
    if (solves()) solve_long_step(step, state);
  }
  if (near) report = resolve_near(step, state);
  job_.end();
  return report;
}

ContactReport ContinuousContact::resolve_near(const ContactStep& step, ClothState& state) {
  ContactReport report;
  const double duration = step.times.step;
  RoundsEnd end = RoundsEnd::arrived;
  if (substeps_ == 1) end = go_rounds(step.system, step.position_before, duration, report);
  for (std::int64_t k = 0; substeps_ > 1 && k < substeps_ && end == RoundsEnd::arrived; ++k) {
    begin_substep(k, step.position_before, state.position);
    end = go_rounds(step.system, substep_from_, duration / static_cast<double>(substeps_), report);
  }
  if (end == RoundsEnd::interrupted) {
    starts_ = starts_before_;
    report.interrupted = true;
    return report;
  }
  if (end != RoundsEnd::arrived) report.pinch = pinch(step.system);
  report.exhausted = end == RoundsEnd::exhausted;
  if (substeps_ > 1) drop_superseded_touches(step.position_before, duration);
  if (!has_moved_ && touches_.empty() && !force_work_) return report;
  report.acted = true;
  report.force_work = force_work_;
  report.rate_work = rate_work_;
  report.pairs = pairs_.size() + waiting_.size();
  std::swap(integrated_position_, state.position);
  copy(position_, team_, state.position);
  take_loads(step, state);
  report.contacts = count_touched();
  solve_velocities(step, state, report);
  return report;
}

/// Moves cloth and obstacles to the end of a substep of `step` seconds that began at `from`.
ContinuousContact::RoundsEnd ContinuousContact::go_rounds(const ClothSystem& system, const Vec3Field& from,
                                                          double step, ContactReport& report) {
  int stuck = 0, rounds_at_rest = 0, idle = 0;
  double least_left = infinity;
  const double arrived = arrived_length();
  while (true) {
    if (stop_test_ && stop_test_()) return RoundsEnd::interrupted;
    ++report.rounds;
    operation_count_ += static_cast<double>(pairs_.size() + position_.size());
    if (!is_separated_) separate_all();
    is_separated_ = false;
    solve_target(system, from);
    keep_touches(step);
    if (part_ < 1) round_from_ = position_;
    const double left = move_cloth();
    has_moved_ = has_moved_ || left > 0;
    const bool is_exhausted = operation_count_ > max_operations(position_.size());
    if (part_ < 1) {
      const double advance = advance_obstacles();
      if (part_ < 1) free_position_ = target_position_, free_contains_contacts_ = true;
      stuck = advance > 0 || furthest_move(round_from_) > arrived ? 0 : stuck + 1;
      if (stuck > max_rounds_stuck) return RoundsEnd::pinched;
      if (part_ < 1 && is_exhausted) return RoundsEnd::exhausted;
    }
    if (part_ == 1) {
      if (left <= arrived || ++rounds_at_rest > max_rounds_at_rest || is_exhausted) break;
      idle = left < progress_part * least_left ? 0 : idle + 1;
      least_left = std::min(least_left, left);
      if (idle > max_rounds_idle) break;
    }
    if (reached_bounds_) find_pairs();
  }
  const bool is_last = substeps_ == 1 || substep_ + 1 == substeps_;
  return operation_count_ > max_operations(position_.size()) && !is_last ? RoundsEnd::exhausted
                                                                         : RoundsEnd::arrived;
}

/// With several substeps a particle's velocity follows from its last substep with a contact impulse, and from
/// the obstacle's velocity in that substep.
void ContinuousContact::drop_superseded_touches(const Vec3Field& from, double step) {
  std::vector<std::int64_t> last(position_.size(), -1);
  for (const Touch& touch : touches_)
    if (touch.contact.normal_impulse > 0)
      touch.contact.for_each([&](std::size_t i) { last[i] = std::max(last[i], touch.substep); });
  std::erase_if(touches_, [&](const Touch& touch) {
    return !touch.contact.any_of([&](std::size_t i) { return last[i] == touch.substep; });
  });
  for (Touch& touch : touches_) touch.contact.rest = touch.contact.point(from) + step * touch.velocity;
}

double ContinuousContact::furthest_move(const Vec3Field& before) const {
  double furthest = 0;
  for (std::size_t i = 0; i < position_.size(); ++i)
    furthest = std::max(furthest, (position_[i] - before[i]).norm());
  return furthest;
}

}  // namespace cloth
