#include "bridge/compare_worker.h"

#include <algorithm>

#include "compare/comparison_log.h"
#include "io/process.h"

namespace clothlab {
namespace {

int threads_for(int wanted) {
  if (wanted > 0) return wanted;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1);
}

using LoadComparison = command::Load<cloth::Comparison>;
using EditComparison = command::Edit<cloth::Comparison>;

/// Whether the command has to wait for a common time.
bool acts_on_the_panes(const Command& command) {
  return command::is_one_of<EditComparison, command::Play, command::SingleStep, command::Brush, command::Pull,
                            command::GoTo, command::PlayAgain, command::GiveRun, command::StartRecording,
                            command::StopRecording>(command);
}

/// Only the newest of several waiting commands of one kind is carried out, because mouse input is faster than
/// the panes.
bool is_replaced_by(const Command& command, const Command& next) {
  return command.index() == next.index() &&
         command::is_one_of<LoadComparison, EditComparison, command::Brush, command::Pull, command::GoTo>(
             command);
}

}  // namespace

CompareWorker::CompareWorker(int threads)
    : threads_(threads_for(threads)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

void CompareWorker::run(const std::stop_token& stop) {
  yield_to_the_window();
  repeat(stop, [&] {
    wait_for_work(stop);
    try {
      handle_waiting();
      if ((status_.playing || under_way_) && !stop.stop_requested()) play_for_a_moment();
    } catch (...) {
      give_up(cloth::failure_in_hand().text);
    }
    if (!under_way_) settled_ = handled_;
    publish_status();
    report_done(settled_, has_work());
  });
  end_recording();
}

/// What was under way when memory ran out may be half done: there are no panes until the next start.
void CompareWorker::give_up(const std::string& why) {
  status_.playing = false;
  under_way_.reset();
  status_.refusal = why;
  end_recording();
  lockstep_.reset();
  handled_ += waiting_.size() + (handling_ ? 1 : 0);
  waiting_.clear();
  handling_ = false;
}

bool CompareWorker::has_work() const {
  return status_.playing || under_way_ || !waiting_.empty();
}

/// Until there is a command, or the panes are due at their next common time. Takes the commands in.
void CompareWorker::wait_for_work(const std::stop_token& stop) {
  std::optional<Clock::time_point> due;
  if (has_work()) due = Clock::now();
  if (status_.playing && waiting_.empty() && !under_way_)
    due = pace_.due_time(lockstep_->time_of(lockstep_->index() + 1));
  auto commands = receive(stop, due);
  std::move(commands.begin(), commands.end(), std::back_inserter(waiting_));
}

/// In their order, up to the first one that has to wait for a common time.
void CompareWorker::handle_waiting() {
  while (!waiting_.empty()) {
    if (waiting_.size() > 1 && is_replaced_by(waiting_[0], waiting_[1]) && !changes_panes(waiting_[0])) {
      waiting_.pop_front();
      ++handled_;
      continue;
    }
    if (under_way_ && acts_on_the_panes(waiting_.front())) return;
    const Command command = std::move(waiting_.front());
    waiting_.pop_front();
    handling_ = true;
    std::visit([this](const auto& c) { handle(c); }, command);
    handling_ = false;
    ++handled_;
  }
}

/// Such an edit is not overtaken: a pane that was copied and then changed is another than a new one.
bool CompareWorker::changes_panes(const Command& command) const {
  const auto* edit = std::get_if<EditComparison>(&command);
  return edit && lockstep_ &&
         !std::equal(edit->content.panes.begin(), edit->content.panes.end(),
                     lockstep_->comparison().panes.begin(), lockstep_->comparison().panes.end(),
                     [](const cloth::Pane& one, const cloth::Pane& other) { return one.name == other.name; });
}

void CompareWorker::handle(const LoadComparison& load) {
  status_.playing = false;
  start(load.content);
}

void CompareWorker::handle(const command::Restart&) {
  if (!lockstep_) return;
  status_.playing = false;
  start(cloth::Comparison(lockstep_->comparison()));
}

void CompareWorker::start(const cloth::Comparison& comparison) {
  end_recording();
  if (!accepts(comparison)) return;
  lockstep_ = std::make_unique<cloth::LockStep>(comparison);
  begin_run();
}

bool CompareWorker::accepts(const cloth::Comparison& comparison) {
  auto problems = cloth::find_problems(comparison);
  if (problems.empty()) problems = cloth::find_start_problems(comparison);
  status_.refusal = problems.empty() ? "" : problems.front().text();
  if (!problems.empty()) status_.playing = false;
  return problems.empty();
}

/// Of panes that are new here.
void CompareWorker::begin_run() {
  under_way_.reset();
  playing_again_ = false;
  marks_ = {};
  lockstep_->keep_history(cloth::History::default_max_bytes);
  ++topology_;
  ++status_.starts;
  restart_clock(now());
  drop_samples();  // of the run before
  last_sampled_ = -1;
  take_sample(true);
  publish_frames();
}

void CompareWorker::handle(const EditComparison& edit) {
  if (!lockstep_) return start(edit.content);
  status_.refusal.clear();
  if (const auto problems = cloth::find_problems(edit.content); !problems.empty()) {
    status_.refusal = problems.front().text();
    return;
  }
  if (!cloth::acts_at_once(lockstep_->comparison(), edit.content)) {
    if (lockstep_->index() > 0) ++status_.new_starts;
    return start(edit.content);
  }
  if (recorder_) log(cloth::comparison_log_lines(lockstep_->comparison(), edit.content, now()));
  begin_branch();
  lockstep_->edit(edit.content);
  marks_ = {};
  lockstep_->keep_history(cloth::History::default_max_bytes);
  publish_frames();
}

void CompareWorker::handle(const command::Play&) {
  if (!lockstep_ || !status_.refusal.empty() || lockstep_->all_stopped()) return;
  begin_branch();
  status_.playing = true;
  restart_clock(now());
}

void CompareWorker::handle(const command::Pause&) {
  status_.playing = false;
  if (lockstep_ && !under_way_) publish_frames();  // what was computed since the last ones
}

void CompareWorker::handle(const command::SingleStep&) {
  status_.playing = false;
  if (!lockstep_ || !status_.refusal.empty() || lockstep_->all_stopped()) return;
  begin_branch();
  under_way_ = lockstep_->index() + 1;
}

void CompareWorker::handle(const command::Brush& brush) {
  if (!lockstep_) return;
  if (recorder_) log(cloth::comparison_log_lines(brush.gust, now()));
  begin_branch();
  lockstep_->set_brush(brush.gust);
}

void CompareWorker::handle(const command::Pull& pull) {
  if (!lockstep_) return;
  if (recorder_) log(cloth::comparison_log_lines(pull.pull, now()));
  begin_branch();
  lockstep_->set_pull(pull.pull);
}

void CompareWorker::handle(const command::Colour& colour) {
  colouring_ = colour.by;
  if (lockstep_) publish_frames();
}

void CompareWorker::handle(const command::ShowContact& show) {
  contact_ = show.choice;
  if (lockstep_) publish_frames();
}

void CompareWorker::handle(const command::StartRecording& start) {
  end_recording();
  if (!lockstep_) return;
  status_.recording_error.clear();
  status_.recording_folder = start.folder;
  status_.recorded_rows = 0;
  recorder_.emplace();
  note_record(recorder_->open(start.folder, *lockstep_));
  if (!recorder_) return;
  note_record(recorder_->add_row(*lockstep_));
  ++status_.recorded_rows;
}

/// To the next common time, if it is due, or as far as it goes until there is a command.
void CompareWorker::play_for_a_moment() {
  if (!under_way_) {
    const std::int64_t next = lockstep_->index() + 1;
    if (!pace_.is_due(lockstep_->time_of(next), Clock::now())) return;
    under_way_ = next;
  }
  const std::stop_token stop = thread_.get_stop_token();
  const auto may_go_on = [this, &stop] { return !has_mail() && !stop.stop_requested(); };
  lockstep_->set_stop_test([stop] { return stop.stop_requested(); });
  if (!lockstep_->advance(*under_way_, may_go_on, threads_)) return;
  under_way_.reset();
  arrive();
}

void CompareWorker::arrive() {
  meter_.count(1, now(), Clock::now());
  if (lockstep_->all_stopped()) {
    status_.playing = false;
    end_recording();
    publish_frames();
    return;
  }
  if (lockstep_->index() > last_sampled_) take_sample(false);
  if (recorder_) {
    note_record(recorder_->add_row(*lockstep_));
    ++status_.recorded_rows;
  }
  if (recorder_ && Clock::now() - last_flush_ > flush_interval) {
    note_record(recorder_->flush());
    last_flush_ = Clock::now();
  }
  const std::int64_t end = playing_again_ ? lockstep_->known_index() : lockstep_->last_index();
  if (lockstep_->index() == end) {
    status_.playing = playing_again_ = false;
    end_recording();
  }
  if (!status_.playing || Clock::now() - last_frame_ >= frame_interval) publish_frames();
}

void CompareWorker::take_sample(bool is_start) {
  CompareSample sample{.time_s = now(), .is_start = is_start};
  for (std::size_t i = 0; i < lockstep_->pane_count(); ++i) {
    const cloth::Lane& lane = lockstep_->lane(i);
    if (!lane.going()) continue;
    const int style = style_of(lockstep_->comparison().panes[i]);
    PaneSample& pane = sample.panes[static_cast<std::size_t>(style)];
    pane.total_J = lane.measurement.energy.total();
    pane.max_strain = lane.measurement.strain.maximum();
    if (is_start && now() == 0) continue;  // no step was taken, and all panes are alike
    pane.step_ms = 1e3 * lane.step_time;
    if (const cloth::Difference* difference = lockstep_->difference(i)) pane.rms_m = difference->rms;
  }
  last_sampled_ = lockstep_->index();
  deliver(sample);
}

void CompareWorker::end_recording() {
  if (!recorder_) return;
  note_end(recorder_->close());
  recorder_.reset();
}

void CompareWorker::publish_frames() {
  for (std::size_t i = 0; i < lockstep_->pane_count(); ++i) publish_frame(i);
  last_frame_ = Clock::now();
}

void CompareWorker::publish_frame(std::size_t pane) {
  const cloth::Lane& lane = lockstep_->lane(pane);
  const auto frame = frames_[pane].blank();
  frame->topology = topology_;
  fill_frame(*lane.simulation, lane.state, normals_, *frame);
  // Contact is that of the simulation's own state, which a pane under way or stopped does not show.
  const bool is_shown = !under_way_ && lane.going();
  contact_filler_.fill(*lane.simulation, is_shown ? contact_ : ContactChoice{}, *frame);
  if (colouring_ == Colouring::difference) {
    static const std::vector<float> none;
    const cloth::Difference* difference = lockstep_->difference(pane);
    show_difference(difference ? difference->distance : none, *frame);
  }
  frames_[pane].publish(frame);
}

void CompareWorker::publish_status() {
  status_.commands = settled_;
  status_.threads = threads_;
  status_.playing_again = status_.playing && playing_again_;
  status_.recording = recorder_.has_value();
  status_.real_time_factor = status_.playing ? meter_.real_time_factor() : 0;
  if (lockstep_ && !under_way_) {
    status_.time = now();
    status_.step = lockstep_->index();
    publish_history();
    status_.duration = lockstep_->time_of(lockstep_->last_index());
    if (!status_.comparison || *status_.comparison != lockstep_->comparison())
      status_.comparison = std::make_shared<cloth::Comparison>(lockstep_->comparison());
    status_.panes = cloth::results_of(*lockstep_);
    status_.reference = cloth::reference_text(*lockstep_);
    const auto reference = lockstep_->reference_lane();
    const bool failed = reference && !lockstep_->lane(*reference).going();
    status_.reference_failure = failed ? cloth::describe(*lockstep_->lane(*reference).divergence) : "";
    status_.floor = lockstep_->floor() ? std::optional(lockstep_->floor()->rms) : std::nullopt;
  }
  publish();
}

}  // namespace clothlab
