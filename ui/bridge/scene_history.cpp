// SceneRun: moving in the history, replaying it, sessions, and passing the run on.
#include <fmt/format.h>

#include "bridge/scene_run.h"
#include "simulation/session_json.h"

namespace clothlab {
namespace {

constexpr auto glimpse_interval = std::chrono::milliseconds(100);  // on a long way

}  // namespace

std::string summary_of(const std::vector<cloth::Problem>& problems) {
  std::string text = problems.front().text();
  if (problems.size() > 1) text += fmt::format(" (and {} more)", problems.size() - 1);
  return text;
}

void SceneRun::go_to(const cloth::HistoryTarget& target, const std::function<bool()>& may_go_on) {
  repeats_ = false;
  status().divergence.reset();
  const auto show_the_way = [&] {
    sample_if_due();
    if (!may_go_on()) return false;
    if (Clock::now() - last_frame_ < glimpse_interval) return true;
    publish_frames();
    publish_status();
    return true;
  };
  settle(history_.go_to(*simulation_, target, show_the_way));
  rows_.follow(*simulation_);
  forget_cost();
  publish_frames();
}

/// Handles the end of a move in the history, whether it succeeded or failed.
void SceneRun::settle(const cloth::HistoryArrival& arrival) {
  if (arrival.divergence) return diverge(*arrival.divergence);
  if (!arrival.problems.empty()) {
    status().session_error = summary_of(arrival.problems);
    status().playing = false;
    begin_branch();  // the history ends where it can be followed
    return;
  }
  if (arrival.arrived && simulation_->state().step == history_.last_step() &&
      !history_.expected_hash().empty())
    status().session_agrees = cloth::state_hash(simulation_->state()) == history_.expected_hash();
}

bool SceneRun::prepare_to_repeat() {
  prepare_to_play();
  repeats_ = simulation_->state().step < history_.last_step();
  return repeats_;
}

/// One step of the history, with what was logged after it.
bool SceneRun::advance_again() {
  const std::size_t logged = history_.commands_until(simulation_->state().step);
  const Clock::time_point start = Clock::now();
  const cloth::HistoryArrival arrival = history_.step(*simulation_);
  wall_since_row_ += seconds(Clock::now() - start);
  settle(arrival);
  if (!arrival.arrived) return false;
  history_.extend(*simulation_);
  ++steps_since_row_;
  sample_if_due();
  const std::int64_t step = simulation_->state().step;
  for (std::size_t n = logged; is_recording() && n < history_.commands_until(step); ++n)
    note_record(recording_.log(history_.commands()[n]));
  if (step < history_.last_step()) return true;
  status().playing = repeats_ = false;
  publish_frames();
  return false;
}

void SceneRun::save_session(const std::filesystem::path& file) {
  cloth::Session session = history_.session(*simulation_);
  session.scene = moved_to_folder(session.scene, file.parent_path().string());
  const auto error = cloth::write_text_file(file, cloth::write_session(session));
  status().session_error = error ? error->text() : "";
}

void SceneRun::open(const cloth::Session& session) {
  settle({.arrived = true, .divergence = {}, .problems = history_.begin(*simulation_, session)});
  rows_.follow(*simulation_);
  publish_frames();
}

cloth::RunWithHistory SceneRun::release(const cloth::Comparison& /*content*/) {
  return {std::move(simulation_), std::move(history_)};
}

}  // namespace clothlab
