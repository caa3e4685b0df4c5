// LockStep: the history of the lanes, and taking over and giving away a run with its history.
#include <algorithm>
#include <cassert>
#include <cmath>

#include "compare/lockstep.h"
#include "scene/scene_edits.h"
#include "simulation/time_step.h"

namespace cloth {

LockStep::LockStep(const Scene& scene, RunWithHistory run)
    : comparison_(comparison_of_one(scene, no_reference)),
      interval_(scene.record.interval),
      last_index_(steps_to_cover(scene.duration, interval_)),
      errors_(1) {
  const double time = run.simulation->time();
  const auto index = static_cast<std::int64_t>(std::floor(time / interval_ + 1e-9));
  origin_ = time - static_cast<double>(index) * interval_;
  if (std::abs(origin_) < 1e-6 * run.simulation->time_step()) origin_ = 0;  // the rounding of summed steps
  auto lane = std::make_unique<Lane>();
  lane->name = comparison_.panes.front().name;
  lane->title = title_of(comparison_, 0);
  lane->start_ = run.history.start_scene();
  lane->simulation = std::move(run.simulation);
  lane->simulation->set_threads(1);  // lanes have a thread each
  lane->history_ = std::move(run.history);
  lane->timed_from = time;
  lane->past_.resize(static_cast<std::size_t>(index));
  lanes_.push_back(std::move(lane));
  arrive(*lanes_.front(), index);
  cut();
  edit_lane(*lanes_.front(), scene);  // in steps that meet
  share_pull_strength();
  compare();
  in_force_.push_back({0, comparison_, weakest_pull()});
}

void LockStep::keep_history(std::size_t max_bytes) {
  const std::size_t each = max_bytes / lanes_.size();
  for (const auto& lane : lanes_) {
    if (lane->history_) {
      lane->history_->set_max_bytes(each);
      continue;
    }
    lane->history_.emplace(each);
    lane->history_->begin(*lane->simulation);
    lane->past_ = {sums_of(*lane)};
  }
  remember_errors();
  if (in_force_.empty()) in_force_.push_back({0, comparison_, weakest_pull()});
}

void LockStep::remember_errors() {
  const auto known = static_cast<std::size_t>(index()) + 1;
  for (Error& error : errors_)
    if (error.past.size() < known) error.past.resize(known, error.sum);
}

std::int64_t LockStep::known_index() const {
  std::int64_t last = index();
  for (const auto& lane : lanes_) last = std::max(last, static_cast<std::int64_t>(lane->past_.size()) - 1);
  return last;
}

std::int64_t LockStep::index_near(double time) const {
  const double index = std::round((time - origin_) / interval_);
  return static_cast<std::int64_t>(std::clamp(index, 0.0, static_cast<double>(known_index())));
}

bool LockStep::repeats(const Lane& lane) const {
  return lane.history_ && lane.simulation->state().step < lane.history_->last_step();
}

bool LockStep::go_to(std::int64_t index, const std::function<bool()>& may_go_on) {
  assert(keeps_history() && index >= 0 && index <= known_index());
  for (const auto& lane : lanes_)
    if (!go_to(*lane, index, may_go_on)) return false;
  put_in_force(index);
  for (Error& error : errors_) {
    const auto k = static_cast<std::size_t>(index);
    error.sum = k < error.past.size() ? error.past[k] : ErrorSum{};
    error.counted = index;
  }
  compare();
  return true;
}

/// A lane that stopped before is then where it stopped. The hand's strength is not part of a lane's history:
/// the way leads over the places where it changed.
bool LockStep::go_to(Lane& lane, std::int64_t index, const std::function<bool()>& may_go_on) {
  const std::int64_t own = std::min(index, static_cast<std::int64_t>(lane.past_.size()) - 1);
  const auto go = [&](std::int64_t to) {
    const HistoryArrival arrival =
        lane.history_->go_to(*lane.simulation, {.step = {}, .time = time_of(to)}, may_go_on);
    assert(arrival.problems.empty());  // it could be carried out before
    return arrival.arrived;
  };
  for (std::size_t k = 0; k < in_force_.size() && in_force_[k].index <= own; ++k) {
    const bool is_last = k + 1 == in_force_.size() || in_force_[k + 1].index > own;
    if (!is_last && in_force_[k].pull == in_force_[k + 1].pull) continue;
    lane.simulation->limit_pull(in_force_[k].pull);
    if (!go(is_last ? own : in_force_[k + 1].index)) return false;
  }
  lane.divergence = own < index ? lane.known_stop_ : std::nullopt;
  lane.index = own;
  lane.state = lane.simulation->state();
  lane.measurement = lane.simulation->measure();
  lane.steps_since_ = 0;
  lane.wall_since_ = 0;
  take_sums(lane, lane.past_[static_cast<std::size_t>(own)]);
  return true;
}

/// What was in force at a common time of the history.
void LockStep::put_in_force(std::int64_t index) {
  const auto later = [](std::int64_t i, const InForce& one) { return i < one.index; };
  const auto next = std::upper_bound(in_force_.begin(), in_force_.end(), index, later);
  if (next == in_force_.begin()) return;
  const InForce& now = *std::prev(next);
  if (comparison_ == now.comparison) return;
  comparison_ = now.comparison;
  last_index_ = steps_to_cover(comparison_.scene.duration, interval_);
  for (std::size_t i = 0; i < pane_count(); ++i) lanes_[i]->title = title_of(comparison_, i);
  share_pull_strength();
}

/// Panes that came are in all of the past, as the copies that they are, and panes that went in none of it;
/// the reference is always the present one.
void LockStep::remember_in_force() {
  if (!keeps_history()) return;
  for (InForce& past : in_force_) {
    Comparison then = past.comparison;
    then.panes.clear();
    for (const Pane& pane : comparison_.panes) {
      const auto was = find_pane(past.comparison, pane.name);
      Pane one = was ? past.comparison.panes[*was] : then.panes.back();
      one.name = pane.name;
      one.title = pane.title;
      then.panes.push_back(std::move(one));
    }
    then.reference = comparison_.reference;
    then.title = comparison_.title;
    past.comparison = std::move(then);
  }
  if (!in_force_.empty() && in_force_.back().index == index()) in_force_.pop_back();
  in_force_.push_back({index(), comparison_, weakest_pull()});
}

void LockStep::cut() {
  if (!keeps_history()) return;
  const auto past = static_cast<std::size_t>(index()) + 1;
  for (const auto& lane : lanes_) {
    if (!lane->going()) continue;
    lane->history_->cut(*lane->simulation);
    lane->past_.resize(std::min(lane->past_.size(), past));
    lane->known_stop_.reset();
  }
  const Lane& first = *lanes_.front();
  if (first.going() &&
      std::abs(first.state.time - time_of(first.index)) > 1e-6 * first.simulation->time_step())
    origin_ =
        first.state.time - static_cast<double>(first.index) * interval_;  // of steps that did not meet there
  for (Error& error : errors_) error.past.resize(std::min(error.past.size(), past));
  while (in_force_.size() > 1 && in_force_.back().index > index()) in_force_.pop_back();
}

std::size_t LockStep::stored_states() const {
  std::size_t states = 0;
  for (const auto& lane : lanes_)
    if (lane->history_) states += lane->history_->state_count();
  return states;
}

std::size_t LockStep::history_bytes() const {
  std::size_t bytes = 0;
  for (const auto& lane : lanes_)
    if (lane->history_) bytes += lane->history_->bytes();
  return bytes;
}

/// Carries it out as a repetition of the history will, and logs it.
void LockStep::perform(Lane& lane, const SessionAction& action) {
  if (is_idle(action, *lane.simulation)) return;
  const auto problems = carry_out(action, *lane.simulation);
  assert(problems.empty());
  if (lane.history_ && problems.empty()) lane.history_->log(action, *lane.simulation);
}

RunWithHistory LockStep::release(std::size_t pane) {
  Lane& lane = *lanes_[pane];
  if (lane.divergence) go_to(lane, lane.index, {});
  lane.simulation->limit_pull(std::nullopt);
  cut();
  return {std::move(lane.simulation), std::move(*lane.history_)};
}

}  // namespace cloth
