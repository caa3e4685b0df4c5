// SimulationWorker: moving in the history, replaying it, and saving and opening sessions.
#include <fmt/format.h>

#include "bridge/simulation_worker.h"
#include "simulation/session_json.h"

namespace clothlab {
namespace {

constexpr auto glimpse_interval = std::chrono::milliseconds(100);  // on a long way

/// A way through the history is not gone to its end when the next thing is to go elsewhere.
bool ends_a_way(const Command& next) {
  return command::is_one_of<command::GoTo, command::Load<cloth::Scene>, command::Restart,
                            command::OpenSession>(next);
}

}  // namespace

void SimulationWorker::handle(const command::GoTo& go) {
  status_.playing = false;
  if (!simulation_) return;
  end_recording();
  playing_again_ = false;
  status_.divergence.reset();
  status_.refusal.clear();  // an earlier refusal no longer applies
  status_.session_error.clear();
  ++status_.jumps;
  settle(history_.go_to(*simulation_, go.target, [this] { return may_go_on(); }));
  rows_.follow(*simulation_);
  wall_since_row_ = 0;
  steps_since_row_ = 0;
  publish_frame();
}

/// Between two steps of a long way: whether to go on, and something to see.
bool SimulationWorker::may_go_on() {
  rows_.follow(*simulation_);
  if (rows_.due(simulation_->state().step)) take_sample();
  if (thread_.get_stop_token().stop_requested()) return false;
  if (batch_is_done_ && next_is(ends_a_way)) return false;
  if (Clock::now() - last_frame_ < glimpse_interval) return true;
  publish_frame();
  publish_status();
  return true;
}

/// Handles the end of a move in the history, whether it succeeded or failed.
void SimulationWorker::settle(const cloth::HistoryArrival& arrival) {
  if (arrival.divergence) return diverge(*arrival.divergence);
  if (!arrival.problems.empty()) {
    show_session_problems(arrival.problems);
    status_.playing = false;
    begin_branch();  // the history ends where it can be followed
    return;
  }
  if (arrival.arrived && simulation_->state().step == history_.last_step() &&
      !history_.expected_hash().empty())
    status_.session_agrees = cloth::state_hash(simulation_->state()) == history_.expected_hash();
}

void SimulationWorker::show_session_problems(const std::vector<cloth::Problem>& problems) {
  status_.session_error = problems.front().text();
  if (problems.size() > 1) status_.session_error += fmt::format(" (and {} more)", problems.size() - 1);
}

void SimulationWorker::handle(const command::PlayAgain&) {
  handle(command::Play{});
  playing_again_ = status_.playing && simulation_->state().step < history_.last_step();
  status_.playing = playing_again_;
}

/// One step of the history, with what was logged after it.
bool SimulationWorker::advance_again() {
  const std::size_t logged = history_.commands_until(simulation_->state().step);
  const Clock::time_point start = Clock::now();
  const cloth::HistoryArrival arrival = history_.step(*simulation_);
  wall_since_row_ += std::chrono::duration<double>(Clock::now() - start).count();
  settle(arrival);
  if (!arrival.arrived) return false;
  history_.extend(*simulation_);
  ++steps_since_row_;
  const std::int64_t step = simulation_->state().step;
  rows_.follow(*simulation_);
  if (rows_.due(step)) take_sample();
  if (recording_.is_active())
    for (std::size_t n = logged; n < history_.commands_until(step); ++n)
      note_record(recording_.log(history_.commands()[n]));
  if (step < history_.last_step()) return true;
  status_.playing = playing_again_ = false;
  publish_frame();
  return false;
}

void SimulationWorker::handle(const command::SaveSession& save) {
  if (!simulation_) return;
  cloth::Session session = history_.session(*simulation_);
  session.scene = moved_to_folder(session.scene, save.file.parent_path().string());
  const auto error = cloth::write_text_file(save.file, cloth::write_session(session));
  status_.session_error = error ? error->text() : "";
}

void SimulationWorker::handle(const command::OpenSession& open) {
  status_.session_error.clear();
  cloth::Session session;
  if (const auto* file = std::get_if<std::filesystem::path>(&open.session)) {
    std::string text;
    if (const auto error = cloth::read_text_file(*file, text)) {
      status_.session_error = error->text();
      return;
    }
    cloth::SessionReading reading = cloth::read_session(text, file->filename().string(),
                                                        cloth::SceneFolder{file->parent_path().string()});
    if (!reading.session) return show_session_problems(reading.problems);
    session = std::move(*reading.session);
  } else {
    session = std::get<cloth::Session>(open.session);
  }
  end_recording();
  if (!start_simulation(session.scene)) {
    std::swap(status_.session_error, status_.refusal);
    return;
  }
  ++topology_;
  ++status_.jumps;
  settle({.arrived = true, .divergence = {}, .problems = history_.begin(*simulation_, session)});
  rows_.follow(*simulation_);
  publish_frame();
}

}  // namespace clothlab
