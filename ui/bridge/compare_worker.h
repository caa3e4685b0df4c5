// The worker of a comparison: owns the simulations of all panes and their threads. The window sends commands
// and fetches frames, samples and status; it never locks a simulation and never waits for one. Commands that
// change the cloths are applied at a common time that all panes have reached.
#pragma once

#include <array>
#include <deque>
#include <thread>

#include "bridge/chart_sample.h"
#include "bridge/fill_frame.h"
#include "bridge/frame_exchange.h"
#include "bridge/history_marks.h"
#include "bridge/worker.h"
#include "bridge/worker_commands.h"
#include "compare/comparison_recorder.h"

namespace clothlab {

class CompareWorker final : public Worker<CompareSample> {
 public:
  /// Runs the panes on `threads` threads; 0: one for each core except one, which is left to the window.
  explicit CompareWorker(int threads = 0);

  /// The pane's newest frame that was not fetched yet, or nullptr. Called by the window's thread.
  std::shared_ptr<const ClothFrame> take_frame(std::size_t pane) { return frames_[pane].take(); }

 private:
  void run(const std::stop_token& stop);
  void give_up(const std::string& why);
  void wait_for_work(const std::stop_token& stop);
  bool has_work() const;
  void handle_waiting();
  bool changes_panes(const Command& command) const;
  void handle(const command::Load<cloth::Comparison>& load);
  void handle(const command::Restart&);
  void handle(const command::Edit<cloth::Comparison>& edit);
  void handle(const command::Play&);
  void handle(const command::Pause&);
  void handle(const command::SingleStep&);
  void handle(const command::Speed& speed) { set_speed(speed.factor, lockstep_ ? now() : 0); }
  void handle(const command::Brush& brush);
  void handle(const command::Pull& pull);
  void handle(const command::Colour& colour);
  void handle(const command::StartRecording& start);
  void handle(const command::StopRecording&) { end_recording(); }
  void handle(const command::ShowContact& show);
  void handle(const command::Load<cloth::Scene>&) {}
  void handle(const command::Edit<cloth::Scene>&) {}
  void handle(const command::SaveSession&) {}
  void handle(const command::OpenSession&) {}
  void handle(const command::GoTo& go);
  void handle(const command::PlayAgain&);
  void handle(const command::GiveRun& give);
  void handle(const command::TakeRun<cloth::Comparison>& take);
  void handle(const command::TakeRun<cloth::Scene>&) {}

  void start(const cloth::Comparison& comparison);
  bool accepts(const cloth::Comparison& comparison);
  void begin_run();
  void begin_branch();
  bool may_go_on() const;
  /// s, the common time that all panes have reached.
  double now() const { return lockstep_->time_of(lockstep_->index()); }
  void log(const std::vector<std::string>& lines) {
    if (recorder_) note_record(recorder_->log(lines));
  }
  void play_for_a_moment();
  void arrive();
  void take_sample(bool is_start);
  void end_recording() override;
  void publish_frames();
  void publish_frame(std::size_t pane);
  void publish_status();
  void publish_history();

  std::array<FrameExchange, cloth::max_panes> frames_;  ///< shared with the window
  int threads_;
  std::deque<Command> waiting_;
  bool handling_ = false;  ///< a command is being carried out and not counted in handled_ yet
  std::uint64_t handled_ = 0,
                settled_ = 0;  ///< commands carried out; settled_: including the step that they requested
  std::unique_ptr<cloth::LockStep> lockstep_;
  std::optional<std::int64_t> under_way_;  ///< index of the common time that the panes are computing
  bool playing_again_ = false;
  std::int64_t last_sampled_ = -1;  ///< index of the last common time of which a sample was sent
  std::optional<cloth::ComparisonRecorder> recorder_;
  std::array<HistoryMarks, cloth::max_panes> marks_;
  Colouring colouring_ = Colouring::strain;
  ContactChoice contact_;
  ContactFiller contact_filler_;
  std::uint64_t topology_ = 0;
  cloth::Vec3Field normals_;  ///< scratch of frames
  Clock::time_point last_flush_{};

  std::jthread thread_;  ///< declared last: it starts after all members are constructed and is joined first;
                         ///< it ends within one step and closes the recording
};

}  // namespace clothlab
