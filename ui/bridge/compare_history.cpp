// CompareWorker: moving in the history of the panes and repeating it, and passing a run on.
#include <algorithm>
#include <tuple>

#include "bridge/compare_worker.h"

namespace clothlab {
namespace {

/// A way through the history is not gone to its end when the next thing is to go elsewhere.
bool goes_elsewhere(const Command& next) {
  return command::is_one_of<command::GoTo, command::Load<cloth::Comparison>, command::Restart>(next);
}

}  // namespace

void CompareWorker::handle(const command::TakeRun<cloth::Comparison>& take) {
  cloth::RunWithHistory run = take.from->get();
  if (!run.simulation) return handle(command::Load{take.content});
  end_recording();
  status_.playing = false;
  if (!accepts(take.content)) return;
  const cloth::Scene scene = run.simulation->scene();
  lockstep_ = std::make_unique<cloth::LockStep>(scene, std::move(run));
  lockstep_->edit(take.content);
  begin_run();
}

void CompareWorker::handle(const command::GiveRun& give) {
  status_.playing = playing_again_ = false;
  end_recording();
  cloth::RunWithHistory given;
  for (std::size_t i = 0; lockstep_ && !given.simulation && i < lockstep_->pane_count(); ++i)
    if (scene_of(lockstep_->comparison(), i) == give.scene) given = lockstep_->release(i);
  lockstep_.reset();
  give.to->set_value(std::move(given));
}

/// Begins a new branch: deletes the history after the present common time.
void CompareWorker::begin_branch() {
  playing_again_ = false;
  lockstep_->cut();
  if (last_sampled_ <= lockstep_->index()) return;
  last_sampled_ = lockstep_->index();
  deliver({.time_s = now(), .is_cut = true, .panes = {}});
}

void CompareWorker::handle(const command::GoTo& go) {
  status_.playing = playing_again_ = false;
  if (!lockstep_) return;
  end_recording();
  status_.refusal.clear();  // an earlier refusal no longer applies
  ++status_.jumps;
  const std::int64_t index = go.target.step
                                 ? std::clamp<std::int64_t>(*go.target.step, 0, lockstep_->known_index())
                                 : lockstep_->index_near(go.target.time);
  lockstep_->set_stop_test([stop = thread_.get_stop_token()] { return stop.stop_requested(); });
  if (lockstep_->go_to(index, [this] { return may_go_on(); })) publish_frames();
}

bool CompareWorker::may_go_on() const {
  if (thread_.get_stop_token().stop_requested()) return false;
  return waiting_.empty() ? !next_is(goes_elsewhere) : !goes_elsewhere(waiting_.front());
}

void CompareWorker::handle(const command::PlayAgain&) {
  if (!lockstep_ || !status_.refusal.empty() || lockstep_->index() >= lockstep_->known_index()) return;
  status_.playing = playing_again_ = true;
  restart_clock(now());
}

/// What was done to one pane alone is marked as what was done to all.
void CompareWorker::publish_history() {
  std::vector<HistoryMark> marks;
  for (std::size_t i = 0; i < lockstep_->pane_count(); ++i) {
    const auto own = marks_[i].of(lockstep_->history_of(i), lockstep_->lane(i).simulation->scene());
    if (own) marks.insert(marks.end(), own->begin(), own->end());
  }
  std::sort(marks.begin(), marks.end(), [](const HistoryMark& a, const HistoryMark& b) {
    return std::tie(a.from, a.to, a.kind, a.what) < std::tie(b.from, b.to, b.kind, b.what);
  });
  marks.erase(std::unique(marks.begin(), marks.end()), marks.end());
  const auto& shown = status_.history.marks;
  const std::int64_t last = lockstep_->known_index();
  status_.history = {.last_step = last,
                     .last_time = lockstep_->time_of(last),
                     .states = lockstep_->stored_states(),
                     .bytes = lockstep_->history_bytes(),
                     .max_bytes = cloth::History::default_max_bytes,
                     .marks = shown && *shown == marks
                                  ? shown
                                  : std::make_shared<const std::vector<HistoryMark>>(std::move(marks))};
}

}  // namespace clothlab
