// The worker of a comparison: owns the panes in lock step and their threads. The window sends commands and
// fetches frames, samples and status; it never locks the panes and never waits for them. What acts on the
// cloth is put in force at a common time that all panes have reached.
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <thread>
#include <variant>
#include <vector>

#include "bridge/compare_status.h"
#include "bridge/frame_exchange.h"
#include "bridge/worker_channel.h"
#include "bridge/worker_pace.h"
#include "compare/comparison_recorder.h"

namespace clothlab {

/// What the frames' colours stand for.
enum class Colouring { strain, difference };

namespace compare_command {
struct Load {
  cloth::Comparison comparison;
};                  ///< a new start, paused
struct Restart {};  ///< the comparison in force, from t = 0, paused
struct Edit {
  cloth::Comparison comparison;
};  ///< in force at once where it can be (see cloth::acts_at_once), else from t = 0; goes on playing
struct Play {};
struct Pause {};       ///< at the common time that is next
struct SingleStep {};  ///< to the next common time
struct Speed {
  double factor;
};  ///< infinity: as fast as it goes
struct Brush {
  std::optional<cloth::BrushGust> gust;
};
struct Pull {
  std::optional<cloth::Pull> pull;
};
struct Colour {
  Colouring by;
};
struct StartRecording {
  std::filesystem::path folder;
};  ///< ends with the duration, a new start, or StopRecording
struct StopRecording {};
}  // namespace compare_command

using CompareCommand =
    std::variant<compare_command::Load, compare_command::Restart, compare_command::Edit,
                 compare_command::Play, compare_command::Pause, compare_command::SingleStep,
                 compare_command::Speed, compare_command::Brush, compare_command::Pull,
                 compare_command::Colour, compare_command::StartRecording, compare_command::StopRecording>;

class CompareWorker {
 public:
  /// Panes run on `threads`; 0: on all cores but one, which is the window's.
  explicit CompareWorker(int threads = 0);
  /// Stops within one step; a recording is ended properly.
  ~CompareWorker();
  CompareWorker(const CompareWorker&) = delete;
  CompareWorker& operator=(const CompareWorker&) = delete;

  void send(CompareCommand command) { channel_.send(std::move(command)); }

  /// The pane's newest frame that was not fetched yet, or nullptr.
  std::shared_ptr<const ClothFrame> take_frame(std::size_t pane) { return frames_[pane].take(); }
  /// Every sample since the last call, in order.
  std::vector<CompareSample> take_samples() { return channel_.take_samples(); }
  CompareStatus status() const { return channel_.status(); }

  /// True while fetching is worth while: playing, or something is waiting to be done or fetched.
  bool is_busy() const { return channel_.is_busy(); }

  /// Blocks until every command sent before is in force. For tests and for closing; the window never calls
  /// it.
  void wait_until_idle() { channel_.wait_until_idle(); }

 private:
  void run(const std::stop_token& stop);
  void give_up(const std::string& why);
  void wait_for_work(const std::stop_token& stop);
  bool has_work() const;
  void handle_waiting();
  bool changes_panes(const CompareCommand& command) const;
  void handle(const compare_command::Load& load);
  void handle(const compare_command::Restart&);
  void handle(const compare_command::Edit& edit);
  void handle(const compare_command::Play&);
  void handle(const compare_command::Pause&);
  void handle(const compare_command::SingleStep&);
  void handle(const compare_command::Speed& speed);
  void handle(const compare_command::Brush& brush);
  void handle(const compare_command::Pull& pull);
  void handle(const compare_command::Colour& colour);
  void handle(const compare_command::StartRecording& start);
  void handle(const compare_command::StopRecording&);

  void start(const cloth::Comparison& comparison);
  double now() const;
  void log(const std::vector<std::string>& lines);
  void play_for_a_moment();
  void arrive();
  void take_sample(bool is_start);
  void note_record(const std::optional<cloth::IoError>& error);
  void end_recording();
  void publish_frames();
  void publish_frame(std::size_t pane);
  void publish_status();

  // Shared with the window.
  WorkerChannel<CompareCommand, CompareSample, CompareStatus> channel_;
  std::array<FrameExchange, cloth::most_panes> frames_;

  // The worker's own.
  int threads_;
  std::deque<CompareCommand> waiting_;
  bool handling_ = false;                    ///< a command that is not yet among handled_
  std::uint64_t handled_ = 0, settled_ = 0;  ///< commands; the second: with the step that they asked for
  std::unique_ptr<cloth::LockStep> lockstep_;
  std::optional<std::int64_t> under_way_;  ///< the common time that panes are on their way to
  std::optional<cloth::ComparisonRecorder> recorder_;
  CompareStatus status_;
  WorkerPace pace_;
  RateMeter meter_;
  Colouring colouring_ = Colouring::strain;
  std::uint64_t topology_ = 0;
  cloth::Vec3Field normals_;  ///< scratch of frames
  WorkerPace::Clock::time_point last_frame_{}, last_flush_{};

  std::jthread thread_;  ///< last: starts when all else is there, stops first
};

}  // namespace clothlab
