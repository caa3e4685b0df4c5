#include "bridge/run_worker.h"

#include <algorithm>

#include "bridge/panes_run.h"
#include "bridge/scene_run.h"
#include "contact/start_check.h"
#include "io/process.h"
#include "scene/scene_checks.h"
#include "simulation/session_json.h"
#include "simulation/time_step.h"

namespace clothlab {
namespace {

int threads_for(int wanted) {
  return wanted > 0 ? wanted : std::max(1, cloth::machine_threads() - 1);
}

std::string text_of(const std::vector<cloth::Problem>& problems) {
  return problems.empty() ? "" : problems.front().text();
}

/// Why something cannot be run, or nothing.
std::string refusal_of(const cloth::Comparison& content) {
  if (!cloth::is_scene(content)) return text_of(cloth::find_problems(content));
  if (const auto problems = cloth::find_problems(content.scene); !problems.empty()) return text_of(problems);
  return cloth::resolved_time_step(content.scene) ? "" : cloth::no_stable_step_text(content.scene);
}

std::string start_refusal_of(const cloth::Comparison& content) {
  return text_of(cloth::is_scene(content) ? cloth::find_start_problems(content.scene)
                                          : cloth::find_start_problems(content));
}

/// Whether the command has to wait for a common time.
bool acts_on_the_panes(const Command& command) {
  return command::is_one_of<command::Edit, command::Play, command::SingleStep, command::Brush, command::Pull,
                            command::GoTo, command::PlayAgain, command::StartRecording,
                            command::StopRecording>(command);
}

/// A way through the history is not gone to its end when the next thing is to go elsewhere.
bool goes_elsewhere(const Command& next) {
  return command::is_one_of<command::GoTo, command::Load, command::Restart, command::OpenSession>(next);
}

bool have_the_same_names(const std::vector<cloth::Pane>& some, const std::vector<cloth::Pane>& others) {
  return std::equal(some.begin(), some.end(), others.begin(), others.end(),
                    [](const cloth::Pane& one, const cloth::Pane& other) { return one.name == other.name; });
}

}  // namespace

RunWorker::RunWorker(int threads, std::size_t max_history)
    : threads_(threads_for(threads)),
      max_history_(max_history),
      thread_([this](const std::stop_token& stop) { work(stop); }) {}

/// Once more after the stop was requested: whatever was sent before is carried out.
void RunWorker::work(const std::stop_token& stop) {
  yield_to_the_window();
  exchange_.stop = stop;
  for (bool last = false; !last;) {
    last = stop.stop_requested();
    wait_for_work();
    try {
      handle_waiting();
      if (run_ && (current().playing || run_->is_under_way()) && !stop.stop_requested())
        run_->play_for_a_moment();
      if (run_) run_->keep_recording_current();
    } catch (...) {
      give_up();
    }
    report();
  }
  end_recording();
}

bool RunWorker::has_work() const {
  return exchange_.status.playing || (run_ && run_->is_under_way()) || !waiting_.empty();
}

/// Until there is a command, or the next step is due. Takes the commands in.
void RunWorker::wait_for_work() {
  std::optional<Clock::time_point> due;
  if (has_work()) due = Clock::now();
  if (current().playing && waiting_.empty() && !run_->is_under_way())
    due = exchange_.pace.due_time(run_->next_time());
  exchange_.receive(waiting_, due);
}

/// In their order, up to the first one that has to wait for a common time.
void RunWorker::handle_waiting() {
  while (!waiting_.empty()) {
    if (run_ && run_->is_under_way() && acts_on_the_panes(waiting_.front())) return;
    RunExchange::Commands first;
    first.splice(first.end(), waiting_, waiting_.begin());
    handling_ = true;
    if (waiting_.empty() || !is_replaced(first.front(), waiting_.front()))
      std::visit([this](const auto& c) { handle(c); }, first.front());
    handling_ = false;
    ++handled_;
  }
}

/// A value that is replaced before the next step need not be put in force: a slider moves faster than a big
/// cloth assembles, and the hand faster than panes meet. An edit of the panes themselves is not overtaken: a
/// pane that was copied and then changed is another than a new one.
bool RunWorker::is_replaced(const Command& command, const Command& next) const {
  if (command.index() != next.index()) return false;
  if (command::is_one_of<command::Load, command::GoTo>(command)) return true;
  const bool has_panes = run_ && !cloth::is_scene(run_->content());
  if (command::is_one_of<command::Brush, command::Pull>(command)) return has_panes;
  const auto* edit = std::get_if<command::Edit>(&command);
  return edit && (!run_ || have_the_same_names(edit->content.panes, run_->content().panes));
}

/// Where not even the status can be made, the window keeps the one before.
void RunWorker::report() {
  const bool under_way = run_ && run_->is_under_way();
  if (!under_way) current().commands = handled_;
  try {
    if (run_)
      run_->publish_status();
    else
      exchange_.publish();
  } catch (...) {
    give_up();
    current().commands = handled_;
  }
  exchange_.report_done(current().commands, has_work());
}

/// What was under way when memory ran out may be half done: there is no run until the next start.
void RunWorker::give_up() {
  current().playing = false;
  end_recording();
  run_.reset();
  handled_ += waiting_.size() + (handling_ ? 1 : 0);
  waiting_.clear();
  handling_ = false;
  current().recording = current().playing_again = false;
  current().refusal = cloth::failure_in_hand().text;
}

void RunWorker::end_recording() {
  if (!run_) return;
  try {
    run_->end_recording();
  } catch (...) {
    current().recording_error = cloth::failure_in_hand().text;
  }
}

bool RunWorker::accepts(const cloth::Comparison& content) {
  current().refusal = refusal_of(content);
  if (current().refusal.empty()) current().refusal = start_refusal_of(content);
  if (!current().refusal.empty()) current().playing = false;
  return current().refusal.empty();
}

void RunWorker::start(const cloth::Comparison& content) {
  end_recording();
  if (!accepts(content)) return;
  if (!run_ || run_->content() != content) ++exchange_.topology;
  if (cloth::is_scene(content))
    put_in_place(std::make_unique<SceneRun>(exchange_, content.scene, threads_, max_history_));
  else
    put_in_place(std::make_unique<PanesRun>(exchange_, content, threads_));
}

void RunWorker::put_in_place(std::unique_ptr<LiveRun> run) {
  run_ = std::move(run);
  run_->begin();
}

void RunWorker::handle(const command::Load& load) {
  current().playing = false;
  start(load.content);
}

void RunWorker::handle(const command::Restart&) {
  if (!run_) return;
  current().playing = false;
  start(run_->content());
}

void RunWorker::handle(const command::Edit& edit) {
  if (!run_) return start(edit.content);
  current().refusal = refusal_of(edit.content);
  if (!current().refusal.empty()) return;
  const cloth::Comparison present = run_->content();
  if (cloth::is_scene(present) != cloth::is_scene(edit.content)) return go_on_as(edit.content);
  if (run_->acts_at_once(edit.content)) {
    current().refusal = run_->edit(edit.content);
  } else {
    if (run_->time() > 0) ++current().new_starts;
    start(edit.content);
  }
}

/// A scene goes on as panes of a comparison, or a pane as a scene.
void RunWorker::go_on_as(const cloth::Comparison& content) {
  current().playing = false;
  end_recording();
  cloth::RunWithHistory given;
  if (run_->acts_at_once(content)) given = run_->release(content);
  if (!given.simulation) return start(content);
  ++exchange_.topology;
  if (!cloth::is_scene(content))
    return put_in_place(std::make_unique<PanesRun>(exchange_, content, threads_, std::move(given)));
  put_in_place(std::make_unique<SceneRun>(exchange_, std::move(given), threads_, max_history_));
  current().refusal = run_->edit(content);
}

bool RunWorker::can_play() const {
  return run_ && exchange_.status.refusal.empty() && !run_->is_over();
}

void RunWorker::play() {
  current().playing = true;
  exchange_.restart_clock(run_->time());
}

void RunWorker::handle(const command::Play&) {
  if (!can_play()) return;
  run_->prepare_to_play();
  play();
}

void RunWorker::handle(const command::PlayAgain&) {
  if (!run_ || !current().refusal.empty()) return;
  current().playing = run_->prepare_to_repeat();
  if (current().playing) play();
}

void RunWorker::handle(const command::Pause&) {
  current().playing = false;
  if (run_ && !run_->is_under_way()) run_->publish_frames();  // what was computed since the last ones
}

void RunWorker::handle(const command::SingleStep&) {
  current().playing = false;
  if (can_play()) run_->single_step();
}

void RunWorker::handle(const command::Speed& speed) {
  current().speed = speed.factor;
  exchange_.pace.set_speed(speed.factor, run_ ? run_->time() : 0, Clock::now());
}

void RunWorker::perform(const cloth::SessionAction& action) {
  if (run_) run_->perform(action);
}

void RunWorker::handle(const command::StartRecording& start) {
  if (!run_) return;
  end_recording();
  current().recording_error.clear();
  current().recording_folder = start.folder;
  run_->start_recording(start.folder);
}

void RunWorker::handle(const command::GoTo& go) {
  current().playing = false;
  if (!run_) return;
  end_recording();
  current().refusal.clear();  // an earlier refusal no longer applies
  current().session_error.clear();
  ++current().jumps;
  run_->go_to(go.target, [this] { return may_go_on(); });
}

bool RunWorker::may_go_on() const {
  if (exchange_.stop.stop_requested()) return false;
  return waiting_.empty() ? !exchange_.next_is(goes_elsewhere) : !goes_elsewhere(waiting_.front());
}

void RunWorker::handle(const command::SaveSession& save) {
  if (run_) run_->save_session(save.file);
}

void RunWorker::handle(const command::OpenSession& open) {
  current().session_error.clear();
  cloth::Session session;
  if (const auto* file = std::get_if<std::filesystem::path>(&open.session)) {
    std::string text;
    if (const auto error = cloth::read_text_file(*file, text)) {
      current().session_error = error->text();
      return;
    }
    cloth::SessionReading reading = cloth::read_session(text, file->filename().string(),
                                                        cloth::SceneFolder{file->parent_path().string()});
    if (!reading.session) {
      current().session_error = summary_of(reading.problems);
      return;
    }
    session = std::move(*reading.session);
  } else {
    session = std::get<cloth::Session>(open.session);
  }
  end_recording();
  current().playing = false;
  if (!accepts(cloth::comparison_of_one(session.scene))) {
    std::swap(current().session_error, current().refusal);
    return;
  }
  auto run = std::make_unique<SceneRun>(exchange_, session.scene, threads_, max_history_);
  SceneRun& opened = *run;
  ++exchange_.topology;
  put_in_place(std::move(run));
  ++current().jumps;
  opened.open(session);
}

void RunWorker::handle(const command::ShowContact& show) {
  exchange_.contact = show.choice;
  if (run_) run_->publish_frames();
}

void RunWorker::handle(const command::Colour& colour) {
  exchange_.colouring = colour.by;
  if (run_) run_->publish_frames();
}

}  // namespace clothlab
