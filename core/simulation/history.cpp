#include "simulation/history.h"

#include <algorithm>
#include <cassert>

#include "io/machine.h"

namespace cloth {
namespace {

std::size_t bytes_of(const SessionCommand& command) {
  std::size_t bytes = sizeof(SessionCommand);
  if (const auto* edits = std::get_if<Edits>(&command.action))
    for (const SceneEdit& edit : *edits) bytes += sizeof(SceneEdit) + edit.path.size() + edit.value.size();
  return bytes;
}

bool has_reached(const HistoryTarget& target, const Simulation& simulation) {
  return target.step ? simulation.state().step >= *target.step
                     : simulation.time() + 0.5 * simulation.time_step() > target.time;
}

bool is_beyond(const HistoryTarget& target, const ClothState& state, double time_step) {
  return target.step ? state.step > *target.step : state.time - 0.5 * time_step > target.time;
}

}  // namespace

void History::start_over(const Simulation& simulation) {
  assert(simulation.state().step == 0);
  scene_ = simulation.scene();
  states_.clear();
  commands_.clear();
  ++command_changes_;
  interval_ = 1;
  last_step_ = 0;
  last_time_ = 0;
  step_changes_.clear();
  expected_hash_.clear();
  state_bytes_ = command_bytes_ = 0;
}

void History::begin(const Simulation& simulation) {
  start_over(simulation);
  keep(simulation);
}

std::vector<Problem> History::begin(Simulation& simulation, const Session& session) {
  start_over(simulation);
  keep(simulation);
  commands_ = session.commands;
  for (const SessionCommand& command : commands_) command_bytes_ += bytes_of(command);
  last_step_ = session.steps;
  last_time_ = session.time;
  step_changes_ = session.step_changes;
  expected_hash_ = session.final_state_hash;
  return carry_out_logged(0, simulation);
}

void History::extend(const Simulation& simulation) {
  if (simulation.state().step < last_step_) return;
  if (simulation.state().step > last_step_) expected_hash_.clear();
  last_step_ = simulation.state().step;
  last_time_ = simulation.time();
  step_changes_ = simulation.step_changes();
}

void History::pop_state() {
  state_bytes_ -= states_.back().bytes();
  states_.pop_back();
}

void History::keep(const Simulation& simulation) {
  const std::int64_t step = simulation.state().step;
  if (!states_.empty() && step < states_.back().step()) return;
  std::shared_ptr<const Scene> scene;
  if (!states_.empty() && *states_.back().scene == simulation.scene()) scene = states_.back().scene;
  if (!scene) scene = std::make_shared<Scene>(simulation.scene());

  // The newest one makes room for the next, unless it is due itself.
  if (!states_.empty() && step == states_.back().step()) pop_state();
  if (states_.size() > 1 && states_.back().step() - states_[states_.size() - 2].step() < interval_)
    pop_state();
  states_.push_back({simulation.checkpoint(), std::move(scene), commands_until(step)});
  state_bytes_ += states_.back().bytes();
  thin_out();
}

/// Doubles the interval until the states fit; the first and the newest stay. States come every so many steps:
/// the interval is then the one that they really have, so that later ones stand as far apart.
void History::thin_out() {
  while (state_bytes_ > max_bytes_ && states_.size() > 2) {
    interval_ *= 2;
    std::vector<State> kept;
    for (std::size_t n = 0; n < states_.size(); ++n) {
      const bool due = kept.empty() || states_[n].step() - kept.back().step() >= interval_;
      if (due || n + 1 == states_.size()) kept.push_back(std::move(states_[n]));
    }
    states_ = std::move(kept);
    if (states_.size() > 2) {
      std::int64_t smallest = states_[1].step() - states_[0].step();
      for (std::size_t n = 2; n + 1 < states_.size(); ++n)
        smallest = std::min(smallest, states_[n].step() - states_[n - 1].step());
      interval_ = smallest;
    }
    state_bytes_ = 0;
    for (const State& state : states_) state_bytes_ += state.bytes();
  }
}

void History::log(SessionAction action, const Simulation& simulation) {
  assert(simulation.state().step == last_step_);
  const bool edits = std::holds_alternative<Edits>(action);
  commands_.push_back({simulation.state().step, simulation.time(), std::move(action)});
  command_bytes_ += bytes_of(commands_.back());
  ++command_changes_;
  expected_hash_.clear();
  if (edits) keep(simulation);  // costly to carry out again, and it may have stopped particles
}

bool History::cut(const Simulation& simulation) {
  const std::int64_t step = simulation.state().step;
  if (step >= last_step_) return false;
  while (!commands_.empty() && commands_.back().step > step) {
    command_bytes_ -= bytes_of(commands_.back());
    commands_.pop_back();
    ++command_changes_;
  }
  while (states_.size() > 1 && states_.back().step() > step) pop_state();
  while (!step_changes_.empty() && step_changes_.back().step > step) step_changes_.pop_back();
  last_step_ = step;
  last_time_ = simulation.time();
  expected_hash_.clear();
  return true;
}

std::size_t History::commands_until(std::int64_t step) const {
  const auto later = [](std::int64_t s, const SessionCommand& command) { return s < command.step; };
  return static_cast<std::size_t>(std::upper_bound(commands_.begin(), commands_.end(), step, later) -
                                  commands_.begin());
}

/// From the `first` command on what is due by now.
std::vector<Problem> History::carry_out_logged(std::size_t first, Simulation& simulation) const {
  for (std::size_t n = first; n < commands_.size() && commands_[n].step <= simulation.state().step; ++n)
    if (auto problems = carry_out(commands_[n].action, simulation); !problems.empty()) return problems;
  return {};
}

std::vector<Problem> History::restore(const State& state, Simulation& simulation) const {
  if (simulation.scene() != *state.scene) simulation.edit(*state.scene);
  simulation.restore(state.checkpoint);
  return carry_out_logged(state.commands, simulation);
}

const History::State& History::nearest(const HistoryTarget& target) const {
  std::size_t n = states_.size() - 1;
  while (n > 0 && is_beyond(target, states_[n].checkpoint.state, states_[n].checkpoint.time_step)) --n;
  return states_[n];
}

HistoryArrival History::step(Simulation& simulation) const {
  const auto first = commands_until(simulation.state().step);
  if (auto divergence = simulation.step())
    return {.arrived = false, .divergence = divergence, .problems = {}};
  if (simulation.interrupted()) return {};
  auto problems = carry_out_logged(first, simulation);
  const bool arrived = problems.empty();
  return {.arrived = arrived, .divergence = {}, .problems = std::move(problems)};
}

HistoryArrival History::go_to(Simulation& simulation, const HistoryTarget& target,
                              const std::function<bool()>& go_on) {
  if (simulation.state().step == last_step_) keep(simulation);  // the way back to the end is then short
  const auto reached = [&] {
    return simulation.state().step >= last_step_ || has_reached(target, simulation);
  };
  const State& from = nearest(target);
  if (simulation.state().step < from.step() || is_beyond(target, simulation.state(), simulation.time_step()))
    if (auto problems = restore(from, simulation); !problems.empty())
      return {.arrived = false, .divergence = {}, .problems = std::move(problems)};
  while (!reached()) {
    HistoryArrival arrival = step(simulation);
    if (!arrival.arrived) return arrival;
    extend(simulation);
    if (go_on && !go_on() && !reached()) return {};
  }
  return {.arrived = true, .divergence = {}, .problems = {}};
}

void History::return_from(const Divergence& divergence, Simulation& simulation) {
  while (states_.size() > 1 && states_.back().step() >= divergence.step) pop_state();
  restore(states_.back(), simulation);
  cut(simulation);
}

Session History::session(const Simulation& simulation) const {
  Session session{.scene = scene_,
                  .commands = commands_,
                  .steps = last_step_,
                  .time = last_time_,
                  .final_state_hash = expected_hash_,
                  .version = version(),
                  .step_changes = step_changes_};
  if (simulation.state().step == last_step_)
    session.final_state_hash = state_hash(simulation.state());
  else if (states_.back().step() == last_step_)
    session.final_state_hash = state_hash(states_.back().checkpoint.state);
  return session;
}

std::vector<double> History::state_times() const {
  std::vector<double> times;
  for (const State& state : states_) times.push_back(state.checkpoint.state.time);
  return times;
}

}  // namespace cloth
