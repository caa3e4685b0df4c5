// The worker: owns the simulation and its thread. The window sends commands and fetches frames, samples and
// status; it never locks the simulation and never waits for it. Edits are put in force between steps.
#pragma once

#include <memory>
#include <thread>
#include <variant>
#include <vector>

#include "bridge/chart_sample.h"
#include "bridge/energy_watch.h"
#include "bridge/fill_contact.h"
#include "bridge/frame_exchange.h"
#include "bridge/live_recording.h"
#include "bridge/worker_channel.h"
#include "bridge/worker_pace.h"
#include "bridge/worker_status.h"
#include "simulation/history.h"
#include "simulation/step_batches.h"

namespace clothlab {

namespace command {
struct Load {
  cloth::Scene scene;
};                  ///< a new start, paused
struct Restart {};  ///< the scene in force, from t = 0, paused
struct Edit {
  cloth::Scene scene;
};  ///< live parameters or pins changed
struct Play {};
struct Pause {};
struct SingleStep {};
struct Speed {
  double factor;
};  ///< infinity: as fast as it goes
struct Brush {
  std::optional<cloth::BrushGust> gust;
};
struct Pull {
  std::optional<cloth::Pull> pull;
};
struct StartRecording {
  std::filesystem::path folder;
};
struct StopRecording {};
struct GoTo {
  cloth::HistoryTarget target;
};                    ///< pauses there; one that comes later takes the place of one that is not there yet
struct PlayAgain {};  ///< what the history has, from here to its end, and pauses there
struct SaveSession {
  std::filesystem::path file;
};  ///< the whole history
struct OpenSession {
  std::variant<std::filesystem::path, cloth::Session> session;
};  ///< a new start, paused, with the session as its history: GoTo and PlayAgain go through it
struct ShowContact {
  ContactChoice choice;
};  ///< what frames tell of contact from now on
}  // namespace command

using Command =
    std::variant<command::Load, command::Restart, command::Edit, command::Play, command::Pause,
                 command::SingleStep, command::Speed, command::Brush, command::Pull, command::StartRecording,
                 command::StopRecording, command::GoTo, command::PlayAgain, command::SaveSession,
                 command::OpenSession, command::ShowContact>;

class SimulationWorker {
 public:
  /// `most_history` bytes of states are kept to go back to.
  explicit SimulationWorker(std::size_t most_history = cloth::History::default_most_bytes);
  /// Stops within one step; a recording is ended properly.
  ~SimulationWorker();
  SimulationWorker(const SimulationWorker&) = delete;
  SimulationWorker& operator=(const SimulationWorker&) = delete;

  void send(Command command) { channel_.send(std::move(command)); }

  /// The newest frame that was not fetched yet, or nullptr.
  std::shared_ptr<const ClothFrame> take_frame() { return frames_.take(); }
  /// Every sample since the last call, in order.
  std::vector<ChartSample> take_samples() { return channel_.take_samples(); }
  WorkerStatus status() const { return channel_.status(); }

  /// True while fetching is worth while: playing, or something is waiting to be done or fetched.
  bool is_busy() const { return channel_.is_busy(); }

  /// Blocks until every command sent before is in force. For tests and for closing; the window never calls
  /// it.
  void wait_until_idle() { channel_.wait_until_idle(); }

 private:
  void run(const std::stop_token& stop);
  std::vector<Command> wait_for_work(const std::stop_token& stop);
  void carry_out(const std::vector<Command>& commands);
  void give_up(const std::string& why);
  void handle(const command::Load& load);
  void handle(const command::Restart&);
  void handle(const command::Edit& edit);
  void handle(const command::Play&);
  void handle(const command::Pause&);
  void handle(const command::SingleStep&);
  void handle(const command::Speed& speed);
  void handle(const command::Brush& brush);
  void handle(const command::Pull& pull);
  void handle(const command::StartRecording& start);
  void handle(const command::StopRecording&);
  void handle(const command::GoTo& go);
  void handle(const command::PlayAgain&);
  void handle(const command::SaveSession& save);
  void handle(const command::OpenSession& open);
  void handle(const command::ShowContact& show);

  bool start_simulation(const cloth::Scene& scene);
  std::vector<cloth::Problem> perform(const cloth::SessionAction& action);
  void begin_branch();
  bool may_go_on();
  void settle(const cloth::HistoryArrival& arrival);
  void drop_later_samples();
  void show_session_problems(const std::vector<cloth::Problem>& problems);
  void play_for_a_moment();
  std::int64_t steps_due(WorkerPace::Clock::time_point now);
  bool advance(std::int64_t steps);
  bool advance_again();
  void take_sample();
  void deliver(const ChartSample& sample);
  void diverge(const cloth::Divergence& divergence);
  void note_record(const std::optional<cloth::IoError>& error);
  void end_recording();
  void publish_frame();
  void publish_status();

  // Shared with the window.
  WorkerChannel<Command, ChartSample, WorkerStatus> channel_;
  FrameExchange frames_;

  // The worker's own.
  std::unique_ptr<cloth::Simulation> simulation_;
  cloth::History history_;
  bool playing_again_ = false;
  bool gave_up_ = false;                 ///< for want of memory, and nothing has been started since
  bool batch_is_done_ = true;            ///< no command waits behind the present one but those in the inbox
  std::int64_t last_sampled_step_ = -1;  ///< samples up to here have been given
  cloth::RowClock rows_;
  LiveRecording recording_;
  EnergyWatch energy_;
  WorkerStatus status_;
  WorkerPace pace_;
  RateMeter meter_;
  cloth::BatchSize batch_;
  std::uint64_t topology_ = 0;
  cloth::Vec3Field normals_;  ///< scratch
  ContactChoice contact_;
  ContactFiller contact_filler_;
  std::optional<ChartSample> first_sample_;  ///< held back until there is a second one: one point is no curve
  double wall_since_row_ = 0;                ///< s
  std::int64_t steps_since_row_ = 0;
  WorkerPace::Clock::time_point last_frame_{};

  std::jthread thread_;  ///< last: starts when all else is there, stops first
};

}  // namespace clothlab
