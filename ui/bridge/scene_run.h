// A scene that runs in the worker, with its history. Edits and the hand act between two steps.
#pragma once

#include "bridge/energy_watch.h"
#include "bridge/history_marks.h"
#include "bridge/live_recording.h"
#include "bridge/live_run.h"
#include "simulation/step_batches.h"

namespace clothlab {

class SceneRun final : public LiveRun {
 public:
  /// From the start. `max_history`: limit of the history's memory, bytes. Precondition: the scene has no
  /// problems.
  SceneRun(RunExchange& exchange, const cloth::Scene& scene, int threads, std::size_t max_history);
  /// Goes on with a run that has been released.
  SceneRun(RunExchange& exchange, cloth::RunWithHistory run, int threads, std::size_t max_history);
  /// Makes a recorded session of this scene the history. Call after begin().
  void open(const cloth::Session& session);

  cloth::Comparison content() const override { return cloth::comparison_of_one(simulation_->scene()); }
  double time() const override { return simulation_->time(); }
  double next_time() const override { return simulation_->time() + simulation_->time_step(); }

  void begin() override;
  bool acts_at_once(const cloth::Comparison& edited) const override;
  std::string edit(const cloth::Comparison& edited) override;
  void perform(const cloth::SessionAction& action) override { try_to_perform(action); }

  void prepare_to_play() override;
  bool prepare_to_repeat() override;
  void single_step() override;
  void play_for_a_moment() override;
  void go_to(const cloth::HistoryTarget& target, const std::function<bool()>& may_go_on) override;

  void start_recording(const std::filesystem::path& folder) override;
  bool is_recording() const override { return recording_.is_active(); }
  void keep_recording_current() override;

  void save_session(const std::filesystem::path& file) override;
  cloth::RunWithHistory release(const cloth::Comparison& content) override;
  void publish_frames() override;

 private:
  void fill_status(WorkerStatus& status) override;
  std::optional<cloth::IoError> close_recording() override;
  std::string notice() const;

  std::vector<cloth::Problem> try_to_perform(const cloth::SessionAction& action);
  void begin_branch();
  void drop_later_samples();
  std::int64_t steps_due(Clock::time_point now);
  bool advance(std::int64_t steps);
  bool advance_again();
  void sample_if_due();
  void take_sample();
  void forget_cost();
  void settle(const cloth::HistoryArrival& arrival);
  void diverge(const cloth::Divergence& divergence);

  std::unique_ptr<cloth::Simulation> simulation_;
  int threads_;
  cloth::History history_;
  HistoryMarks marks_;
  std::int64_t last_sampled_step_ = -1;  ///< the step of the last sample sent
  cloth::RowClock rows_;
  LiveRecording recording_;
  EnergyWatch energy_;
  cloth::BatchSize batch_;
  std::optional<ChartSample>
      first_sample_;  ///< sent together with the second sample, because one point is not a curve
  std::shared_ptr<const std::vector<std::string>> probe_columns_;  ///< of the samples sent
  double wall_since_row_ = 0;                                      ///< s
  std::int64_t steps_since_row_ = 0;
};

/// The first problem, and how many more there are.
std::string summary_of(const std::vector<cloth::Problem>& problems);

}  // namespace clothlab
