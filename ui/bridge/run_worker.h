// The worker of a window: owns what runs, a scene or the panes of a comparison, and the thread that computes
// it. The window sends commands and fetches frames, samples and status; it never locks a simulation and never
// waits for one. A failed allocation or another exception ends the run and becomes a refusal in the status.
#pragma once

#include <thread>

#include "bridge/live_run.h"

namespace clothlab {

class RunWorker {
 public:
  /// `threads`: of the computation; 0: one for each core except one, which is left to the window.
  /// `max_history`: limit of the memory of a scene's history, bytes.
  explicit RunWorker(int threads = 0, std::size_t max_history = cloth::History::default_max_bytes);

  // See RunExchange.
  std::uint64_t send(Command command) { return exchange_.send(std::move(command)); }
  std::shared_ptr<const ClothFrame> take_frame(std::size_t pane = 0) { return exchange_.frames[pane].take(); }
  std::vector<ChartSample> take_samples() { return exchange_.take_samples(); }
  std::vector<CompareSample> take_pane_samples() { return exchange_.take_pane_samples(); }
  WorkerStatus status() const { return exchange_.newest_status(); }
  bool is_busy() const { return exchange_.is_busy(); }
  void wait_until_idle() { exchange_.wait_until_idle(); }

 private:
  using Clock = RunExchange::Clock;

  void work(const std::stop_token& stop);
  void wait_for_work();
  bool has_work() const;
  void handle_waiting();
  bool is_replaced(const Command& command, const Command& next) const;
  void report();
  void give_up();
  void end_recording();

  void handle(const command::Load& load);
  void handle(const command::Restart&);
  void handle(const command::Edit& edit);
  void handle(const command::Play&);
  void handle(const command::Pause&);
  void handle(const command::SingleStep&);
  void handle(const command::Speed& speed);
  void handle(const command::Brush& brush) { perform(brush.gust); }
  void handle(const command::Pull& pull) { perform(pull.pull); }
  void handle(const command::StartRecording& start);
  void handle(const command::StopRecording&) { end_recording(); }
  void handle(const command::GoTo& go);
  void handle(const command::PlayAgain&);
  void handle(const command::SaveSession& save);
  void handle(const command::OpenSession& open);
  void handle(const command::ShowContact& show);
  void handle(const command::Colour& colour);

  bool accepts(const cloth::Comparison& content);
  void start(const cloth::Comparison& content);
  void put_in_place(std::unique_ptr<LiveRun> run);
  void go_on_as(const cloth::Comparison& content);
  void perform(const cloth::SessionAction& action);
  bool can_play() const;
  void play();
  bool may_go_on() const;
  WorkerStatus& current() { return exchange_.status; }

  RunExchange exchange_;
  int threads_;
  std::size_t max_history_;
  RunExchange::Commands waiting_;
  std::unique_ptr<LiveRun> run_;
  std::uint64_t handled_ = 0;  ///< commands carried out
  bool handling_ = false;      ///< a command is being carried out and not counted in handled_ yet

  std::jthread thread_;  ///< declared last: it starts after all members are constructed and is joined first;
                         ///< it ends within one step and closes the recording
};

}  // namespace clothlab
