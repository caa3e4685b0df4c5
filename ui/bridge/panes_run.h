// The panes of a comparison that run in the worker, with a history each. Commands that change the cloths act
// at a common time that all panes have reached.
#pragma once

#include "bridge/history_marks.h"
#include "bridge/live_run.h"
#include "compare/comparison_recorder.h"

namespace clothlab {

class PanesRun final : public LiveRun {
 public:
  /// From the start, on `threads` threads. Precondition: the comparison has no problems.
  PanesRun(RunExchange& exchange, const cloth::Comparison& comparison, int threads);
  /// Goes on with the run of a scene that has been released. Precondition: the comparison acts at once in it.
  PanesRun(RunExchange& exchange, const cloth::Comparison& comparison, int threads,
           cloth::RunWithHistory run);

  cloth::Comparison content() const override { return lockstep_->comparison(); }
  double time() const override { return lockstep_->time_of(lockstep_->index()); }
  double next_time() const override { return lockstep_->time_of(lockstep_->index() + 1); }
  bool is_under_way() const override { return under_way_.has_value(); }
  bool is_over() const override { return lockstep_->all_stopped(); }

  void begin() override;
  bool acts_at_once(const cloth::Comparison& edited) const override {
    return cloth::is_scene(edited) || cloth::acts_at_once(lockstep_->comparison(), edited);
  }
  std::string edit(const cloth::Comparison& edited) override;
  void perform(const cloth::SessionAction& action) override;

  void prepare_to_play() override { begin_branch(); }
  bool prepare_to_repeat() override;
  void single_step() override;
  void play_for_a_moment() override;
  void go_to(const cloth::HistoryTarget& target, const std::function<bool()>& may_go_on) override;

  void start_recording(const std::filesystem::path& folder) override;
  bool is_recording() const override { return recorder_.has_value(); }
  void keep_recording_current() override;

  cloth::RunWithHistory release(const cloth::Comparison& content) override;
  void publish_frames() override;

 private:
  void fill_status(WorkerStatus& status) override;
  std::optional<cloth::IoError> close_recording() override;
  void fill_history(HistoryStatus& history);

  void keep_history();
  void begin_branch();
  void log(const std::vector<std::string>& lines);
  void arrive();
  void add_row();
  void take_sample(bool is_start);
  std::shared_ptr<const std::vector<std::string>> columns_of(const cloth::Lane& lane);

  std::unique_ptr<cloth::LockStep> lockstep_;
  int threads_;
  std::optional<std::int64_t> under_way_;  ///< index of the common time that the panes are computing
  std::shared_ptr<const std::vector<std::string>> probe_columns_;  ///< of the samples sent
  std::int64_t last_sampled_ = -1;  ///< index of the last common time of which a sample was sent
  std::optional<cloth::ComparisonRecorder> recorder_;
  std::array<HistoryMarks, cloth::max_panes> marks_;
  Clock::time_point last_flush_{};
};

}  // namespace clothlab
