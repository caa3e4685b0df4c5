// PanesRun: moving in the history of the panes, repeating it, and passing a run on.
#include <algorithm>
#include <tuple>

#include "bridge/panes_run.h"

namespace clothlab {

cloth::RunWithHistory PanesRun::release(const cloth::Comparison& content) {
  for (std::size_t i = 0; i < lockstep_->pane_count(); ++i)
    if (scene_of(lockstep_->comparison(), i) == content.scene) return lockstep_->release(i);
  return cloth::RunWithHistory();
}

/// Begins a new branch: deletes the history after the present common time.
void PanesRun::begin_branch() {
  repeats_ = false;
  lockstep_->cut();
  if (last_sampled_ <= lockstep_->index()) return;
  last_sampled_ = lockstep_->index();
  exchange_.deliver(CompareSample{.time_s = time(), .is_cut = true, .panes = {}});
}

void PanesRun::go_to(const cloth::HistoryTarget& target, const std::function<bool()>& may_go_on) {
  repeats_ = false;
  const std::int64_t index = target.step ? std::clamp<std::int64_t>(*target.step, 0, lockstep_->known_index())
                                         : lockstep_->index_near(target.time);
  if (lockstep_->go_to(index, may_go_on)) publish_frames();
}

bool PanesRun::prepare_to_repeat() {
  repeats_ = lockstep_->index() < lockstep_->known_index();
  return repeats_;
}

/// What was done to one pane alone is marked as what was done to all.
void PanesRun::fill_history(HistoryStatus& history) {
  std::vector<HistoryMark> marks;
  for (std::size_t i = 0; i < lockstep_->pane_count(); ++i) {
    const auto own = marks_[i].of(lockstep_->history_of(i), lockstep_->lane(i).simulation->scene());
    if (own) marks.insert(marks.end(), own->begin(), own->end());
  }
  std::sort(marks.begin(), marks.end(), [](const HistoryMark& a, const HistoryMark& b) {
    return std::tie(a.from, a.to, a.kind, a.what) < std::tie(b.from, b.to, b.kind, b.what);
  });
  marks.erase(std::unique(marks.begin(), marks.end()), marks.end());
  if (!history.marks || *history.marks != marks)
    history.marks = std::make_shared<const std::vector<HistoryMark>>(std::move(marks));
  history.last_step = lockstep_->known_index();
  history.last_time = lockstep_->time_of(history.last_step);
  history.states = lockstep_->stored_states();
  history.bytes = lockstep_->history_bytes();
  history.max_bytes = cloth::History::default_max_bytes;
}

}  // namespace clothlab
