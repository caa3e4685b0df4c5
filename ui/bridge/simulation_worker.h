// The worker of one scene: owns the simulation and the thread that computes it. The window sends commands and
// fetches frames, samples and status; it never locks the simulation and never waits for it. Edits are applied
// between steps.
#pragma once

#include <thread>

#include "bridge/chart_sample.h"
#include "bridge/energy_watch.h"
#include "bridge/fill_frame.h"
#include "bridge/frame_exchange.h"
#include "bridge/history_marks.h"
#include "bridge/live_recording.h"
#include "bridge/worker.h"
#include "bridge/worker_commands.h"
#include "simulation/step_batches.h"

namespace clothlab {

class SimulationWorker final : public Worker<ChartSample> {
 public:
  /// `max_history`: limit of the history's memory, bytes.
  explicit SimulationWorker(std::size_t max_history = cloth::History::default_max_bytes);

  /// The newest frame that was not fetched yet, or nullptr. Called by the window's thread.
  std::shared_ptr<const ClothFrame> take_frame(std::size_t pane = 0) {
    return pane == 0 ? frames_.take() : nullptr;
  }

 private:
  void run(const std::stop_token& stop);
  std::vector<Command> wait_for_work(const std::stop_token& stop);
  void carry_out(const std::vector<Command>& commands);
  void give_up(const std::string& why);
  void handle(const command::Load<cloth::Scene>& load);
  void handle(const command::Restart&);
  void handle(const command::Edit<cloth::Scene>& edit);
  void handle(const command::Play&);
  void handle(const command::Pause&);
  void handle(const command::SingleStep&);
  void handle(const command::Speed& speed) { set_speed(speed.factor, simulation_ ? simulation_->time() : 0); }
  void handle(const command::Brush& brush) { perform(brush.gust); }
  void handle(const command::Pull& pull) { perform(pull.pull); }
  void handle(const command::StartRecording& start);
  void handle(const command::StopRecording&) { end_recording(); }
  void handle(const command::GoTo& go);
  void handle(const command::PlayAgain&);
  void handle(const command::SaveSession& save);
  void handle(const command::OpenSession& open);
  void handle(const command::ShowContact& show);
  void handle(const command::GiveRun& give);
  void handle(const command::TakeRun<cloth::Scene>& take);
  void handle(const command::TakeRun<cloth::Comparison>&) {}
  void handle(const command::Load<cloth::Comparison>&) {}
  void handle(const command::Edit<cloth::Comparison>&) {}
  void handle(const command::Colour&) {}

  bool start_simulation(const cloth::Scene& scene);
  void begin_run();
  std::vector<cloth::Problem> perform(const cloth::SessionAction& action);
  void begin_branch();
  bool may_go_on();
  void settle(const cloth::HistoryArrival& arrival);
  void drop_later_samples();
  void show_session_problems(const std::vector<cloth::Problem>& problems);
  void play_for_a_moment();
  std::int64_t steps_due(Clock::time_point now);
  bool advance(std::int64_t steps);
  bool advance_again();
  void take_sample();
  void diverge(const cloth::Divergence& divergence);
  void end_recording() override;
  void publish_frame();
  void publish_status();

  FrameExchange frames_;  ///< shared with the window
  std::unique_ptr<cloth::Simulation> simulation_;
  cloth::History history_;
  HistoryMarks marks_;
  bool playing_again_ = false;
  bool gave_up_ = false;                 ///< memory ran out, and no scene has been started since
  bool batch_is_done_ = true;            ///< the present command is the last of those received together
  std::int64_t last_sampled_step_ = -1;  ///< the step of the last sample sent
  cloth::RowClock rows_;
  LiveRecording recording_;
  EnergyWatch energy_;
  cloth::BatchSize batch_;
  std::uint64_t topology_ = 0;
  cloth::Vec3Field normals_;  ///< scratch
  ContactChoice contact_;
  ContactFiller contact_filler_;
  std::optional<ChartSample>
      first_sample_;           ///< sent together with the second sample, because one point is not a curve
  double wall_since_row_ = 0;  ///< s
  std::int64_t steps_since_row_ = 0;

  std::jthread thread_;  ///< declared last: it starts after all members are constructed and is joined first;
                         ///< it ends within one step and closes the recording
};

}  // namespace clothlab
