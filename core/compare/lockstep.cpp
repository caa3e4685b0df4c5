#include "compare/lockstep.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cmath>

#include "integrators/registry.h"
#include "scene/scene_edits.h"
#include "simulation/in_threads.h"
#include "simulation/recorder.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

using Clock = std::chrono::steady_clock;

const char* const reference_name = "reference";
const char* const check_name = "check";

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string notice_of(const Scene& asked, const Simulation& simulation) {
  std::string notice;
  if (const double step = resolved_time_step(asked).value(); step != simulation.time_step())
    notice = fmt::format(
        "a step of {:.6g} s does not divide the record interval of {:.6g} s: run with {:.6g} s instead", step,
        asked.record.interval, simulation.time_step());
  if (const auto& unreachable = simulation.unreachable_rate())
    notice += (notice.empty() ? "" : "; ") + describe(*unreachable, simulation.system());
  return notice;
}

std::string controlled_title(const Scene& scene) {
  const MethodFacts& facts = facts_of(scene.integrator.method);
  if (facts.settings == MethodSettings::error_control)
    return fmt::format("{}, tolerance {:.0e}", facts.title, scene.integrator.tolerance);
  return fmt::format("{}, step {:.3g} s", facts.title, *scene.integrator.time_step);
}

}  // namespace

Scene in_lock_step(const Scene& scene) {
  if (!scene.integrator.time_step)
    return scene;  // "auto" divides the interval, also where it shortens the step
  Scene resolved = scene;
  resolved.integrator.time_step = step_dividing(scene.record.interval, resolved_time_step(scene).value());
  return resolved;
}

std::string uneven_intervals_text(const Scene& scene) {
  const double interval = scene.record.interval;
  if (uneven_duration_text(scene.duration, interval).empty()) return "";
  return fmt::format(
      "duration = {:.6g} s is no whole number of record intervals of {:.6g} s: all panes run to {:.6g} s, "
      "where "
      "they meet",
      scene.duration, interval, static_cast<double>(steps_to_cover(scene.duration, interval)) * interval);
}

LockStep::LockStep(const Comparison& comparison)
    : comparison_(comparison),
      interval_(comparison.scene.record.interval),
      last_index_(steps_to_cover(comparison.scene.duration, interval_)),
      errors_(comparison.panes.size()) {
  for (std::size_t i = 0; i < comparison_.panes.size(); ++i)
    add_lane(comparison_.panes[i].name, title_of(comparison_, i), scene_of(comparison_, i));
  if (comparison_.reference == controlled_reference) {
    const ControlledScenes scenes = controlled_scenes(comparison_);
    add_lane(reference_name, controlled_title(scenes.reference), scenes.reference);
    add_lane(check_name, controlled_title(scenes.check), scenes.check);
  }
  share_pull_strength();
  compare();
}

LockStep::~LockStep() = default;

void LockStep::add_lane(const std::string& name, const std::string& title, const Scene& scene) {
  auto lane = std::make_unique<Lane>();
  lane->name = name;
  lane->title = title;
  lane->start_ = in_lock_step(scene);
  lane->simulation = std::make_unique<Simulation>(lane->start_);
  lane->notice = notice_of(scene, *lane->simulation);
  arrive(*lane, 0);
  lanes_.push_back(std::move(lane));
}

std::optional<std::size_t> LockStep::reference_lane() const {
  if (comparison_.reference == controlled_reference) return pane_count();
  return find_pane(comparison_, comparison_.reference);
}

std::int64_t LockStep::index() const {
  std::int64_t least = -1, most = 0;
  for (const auto& lane : lanes_) {
    most = std::max(most, lane->index);
    if (lane->going()) least = least < 0 ? lane->index : std::min(least, lane->index);
  }
  return least < 0 ? most : least;
}

bool LockStep::all_stopped() const {
  return std::none_of(lanes_.begin(), lanes_.begin() + static_cast<std::ptrdiff_t>(pane_count()),
                      [](const auto& lane) { return lane->going(); });
}

Lane::Sums LockStep::sums_of(const Lane& lane) {
  return {lane.step_time, lane.wall, lane.max_strain, lane.limiter_excess, lane.energy};
}

void LockStep::take_sums(Lane& lane, const Lane::Sums& sums) {
  lane.step_time = sums.step_time;
  lane.wall = sums.wall;
  lane.max_strain = sums.max_strain;
  lane.limiter_excess = sums.limiter_excess;
  lane.energy = sums.energy;
}

void LockStep::arrive(Lane& lane, std::int64_t index) {
  lane.index = index;
  lane.state = lane.simulation->state();
  lane.measurement = lane.simulation->measure();
  lane.max_strain = std::max(lane.max_strain, lane.measurement.strain.maximum());
  lane.limiter_excess = std::max(lane.limiter_excess, lane.measurement.limiter_excess);
  lane.energy.add(lane.measurement);
  lane.step_time = lane.steps_since_ > 0 ? lane.wall_since_ / static_cast<double>(lane.steps_since_) : 0;
  lane.wall += lane.wall_since_;
  lane.steps_since_ = 0;
  lane.wall_since_ = 0;
  if (!lane.history_) return;
  const auto known = static_cast<std::int64_t>(lane.past_.size());
  if (index < known) return take_sums(lane, lane.past_[static_cast<std::size_t>(index)]);
  lane.past_.push_back(sums_of(lane));
  lane.history_->keep(*lane.simulation);
}

bool LockStep::advance_lane(std::size_t number, std::int64_t index, const std::function<bool()>& may_go_on) {
  Lane& lane = *lanes_[number];
  while (lane.going() && lane.index < index) {
    const double next = time_of(lane.index + 1);
    const auto is_there = [&] { return lane.simulation->time() > next - 0.5 * lane.simulation->time_step(); };
    while (!lane.divergence && !is_there()) {
      if (may_go_on && !may_go_on()) break;
      const double step = lane.simulation->time_step();
      if (!step_lane(lane, steps_beyond(*lane.simulation, next - 0.5 * step))) break;
    }
    if (lane.divergence) {
      lane.wall += lane.wall_since_;
      lane.known_stop_ = lane.divergence;
    } else if (!is_there()) {
      return false;
    } else {
      arrive(lane, lane.index + 1);
    }
  }
  return true;
}

/// A batch of steps, at most `left`; within the history the next step of it. False if it was interrupted.
bool LockStep::step_lane(Lane& lane, std::int64_t left) {
  const std::int64_t begin = lane.simulation->state().step;
  const Clock::time_point start = Clock::now();
  if (repeats(lane))
    lane.divergence = lane.history_->step(*lane.simulation).divergence;
  else
    lane.divergence = lane.simulation->advance(std::min(left, lane.batch_.steps()));
  const double taken = seconds_since(start);
  const std::int64_t steps = lane.simulation->state().step - begin;
  lane.wall_since_ += taken;
  lane.steps_since_ += steps;
  if (lane.simulation->interrupted()) return false;
  if (lane.divergence) return true;
  lane.batch_.note(std::max<std::int64_t>(1, steps), taken);
  if (lane.history_) lane.history_->extend(*lane.simulation);
  return true;
}

void LockStep::measure(Error& error, std::size_t lane, std::size_t against) {
  const Lane &one = *lanes_[lane], &other = *lanes_[against];
  error.present = lane != against && one.going() && other.going();
  if (!error.present) return;
  assert(one.index == index() && other.index == index());
  measure_difference(one.state.position, other.state.position, error.difference);
  if (one.index <= error.counted) return;
  error.sum.squares += error.difference.rms * error.difference.rms;
  ++error.sum.times;
  error.counted = one.index;
}

void LockStep::compare() {
  const std::optional<std::size_t> against = reference_lane();
  if (!against) return;
  for (std::size_t i = 0; i < errors_.size(); ++i) measure(errors_[i], i, *against);
  if (*against == pane_count()) measure(floor_, pane_count() + 1, pane_count());
  if (keeps_history()) remember_errors();
}

void LockStep::set_stop_test(const std::function<bool()>& test) {
  for (const auto& lane : lanes_) lane->simulation->set_stop_test(test);
}

bool LockStep::advance(std::int64_t index, const std::function<bool()>& may_go_on, int threads) {
  std::atomic<bool> whole{true};
  in_threads(lanes_.size(), threads, [&](std::size_t i) {
    if (!advance_lane(i, index, may_go_on)) whole = false;
  });
  if (!whole) return false;
  if (keeps_history()) put_in_force(index);
  compare();
  return true;
}

const Difference* LockStep::difference(std::size_t pane) const {
  return errors_[pane].present ? &errors_[pane].difference : nullptr;
}

std::optional<double> LockStep::rms_over_time(std::size_t pane) const {
  const Error& error = errors_[pane];
  if (error.sum.times == 0) return std::nullopt;
  return std::sqrt(error.sum.squares / static_cast<double>(error.sum.times));
}

/// Another run of the same past: it goes on as `from` does, to the bit.
std::unique_ptr<Lane> LockStep::copy_of(const Lane& from) {
  auto lane = std::make_unique<Lane>();
  lane->notice = from.notice;
  lane->simulation = std::make_unique<Simulation>(from.start_);
  lane->simulation->edit(from.simulation->scene());
  lane->simulation->restore(from.simulation->checkpoint());
  lane->index = from.index;
  lane->state = from.state;
  lane->measurement = from.measurement;
  lane->step_time = from.step_time;
  lane->wall = from.wall;
  lane->max_strain = from.max_strain;
  lane->limiter_excess = from.limiter_excess;
  lane->energy = from.energy;
  lane->divergence = from.divergence;
  lane->timed_from = from.timed_from;
  lane->start_ = from.start_;
  lane->history_ = from.history_;
  lane->past_ = from.past_;
  lane->known_stop_ = from.known_stop_;
  return lane;
}

/// Lanes and errors in the order of the edited panes; a new pane's are those of the pane before it.
void LockStep::take_panes(const Comparison& edited) {
  std::vector<std::unique_ptr<Lane>> lanes;
  std::vector<Error> errors;
  for (const Pane& pane : edited.panes) {
    if (const auto was = find_pane(comparison_, pane.name)) {
      lanes.push_back(std::move(lanes_[*was]));
      errors.push_back(std::move(errors_[*was]));
    } else {
      lanes.push_back(copy_of(*lanes.back()));
      lanes.back()->name = pane.name;
      errors.push_back(errors.back());
    }
  }
  if (edited.reference == controlled_reference)
    std::move(lanes_.begin() + static_cast<std::ptrdiff_t>(pane_count()), lanes_.end(),
              std::back_inserter(lanes));
  lanes_ = std::move(lanes);
  errors_ = std::move(errors);
}

/// What is in force already stays untouched: an edit makes a method forget what it remembers.
void LockStep::edit_lane(Lane& lane, const Scene& scene) {
  const Scene resolved = in_lock_step(scene);
  if (resolved == lane.simulation->scene()) return;
  perform(lane, edits_between(lane.simulation->scene(), resolved));
  lane.notice = notice_of(scene, *lane.simulation);
  lane.measurement = lane.simulation->measure();
}

void LockStep::edit(const Comparison& edited) {
  assert(acts_at_once(comparison_, edited));
  cut();
  take_panes(edited);
  if (edited.reference != comparison_.reference) {
    for (Error& error : errors_) error = {};
    floor_ = {};
  }
  comparison_ = edited;
  last_index_ = steps_to_cover(comparison_.scene.duration, interval_);
  std::vector<Scene> scenes;
  for (std::size_t i = 0; i < pane_count(); ++i) scenes.push_back(scene_of(comparison_, i));
  if (lanes_.size() > pane_count()) {
    ControlledScenes controlled = controlled_scenes(comparison_);
    scenes.push_back(std::move(controlled.reference));
    scenes.push_back(std::move(controlled.check));
  }
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    Lane& lane = *lanes_[i];
    lane.title = i < pane_count() ? title_of(comparison_, i) : controlled_title(scenes[i]);
    if (lane.going()) edit_lane(lane, scenes[i]);
  }
  share_pull_strength();
  compare();
  remember_in_force();
}

void LockStep::set_brush(const std::optional<BrushGust>& brush) {
  cut();
  for (const auto& lane : lanes_)
    if (lane->going()) perform(*lane, brush);
}

void LockStep::set_pull(const std::optional<Pull>& pull) {
  cut();
  for (const auto& lane : lanes_)
    if (lane->going()) perform(*lane, pull);
}

/// A pane beyond its method's limit could bear no hand at all; it must not take it from the others.
std::optional<PullStrength> LockStep::weakest_pull() const {
  std::optional<PullStrength> weakest;
  for (const auto& lane : lanes_) {
    const PullStrength& own = lane->simulation->strongest_pull();
    if (!lane->going() || !(own.stiffness > 0)) continue;
    if (!weakest) weakest = own;
    weakest->stiffness = std::min(weakest->stiffness, own.stiffness);
    weakest->damping = std::min(weakest->damping, own.damping);
  }
  return weakest;
}

void LockStep::share_pull_strength() {
  const std::optional<PullStrength> weakest = weakest_pull();
  for (const auto& lane : lanes_)
    if (lane->going()) lane->simulation->limit_pull(weakest);
}

}  // namespace cloth
