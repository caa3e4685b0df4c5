// Exchanges data between the window's thread and the worker's thread: commands in; frames, samples and status
// out. The window never waits for a computation: the mutex is held only while data are moved. Frames pass
// through FrameExchange.
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

#include "bridge/chart_sample.h"
#include "bridge/frame_exchange.h"
#include "bridge/worker_commands.h"
#include "bridge/worker_pace.h"
#include "bridge/worker_status.h"

namespace clothlab {

class RunExchange {
 public:
  static constexpr std::size_t max_samples = 1 << 18;  ///< more than an hour at 60 samples a second
  using Clock = WorkerPace::Clock;
  using Commands = std::list<Command>;  ///< passed on without an allocation, which could fail

  // --- Called by the window's thread ---

  /// Returns the number of commands sent so far; see WorkerStatus::commands.
  std::uint64_t send(Command command) {
    std::uint64_t number;
    {
      const std::lock_guard lock(mutex_);
      inbox_.push_back(std::move(command));
      number = ++sent_;
      busy_ = true;
      has_mail_ = true;
    }
    wake_.notify_one();
    return number;
  }

  /// Every sample of a scene, or of the panes of a comparison, since the last call, in order.
  std::vector<ChartSample> take_samples() {
    const std::lock_guard lock(mutex_);
    return std::exchange(samples_, {});
  }
  std::vector<CompareSample> take_pane_samples() {
    const std::lock_guard lock(mutex_);
    return std::exchange(pane_samples_, {});
  }

  /// The newest status; copied outside the lock.
  WorkerStatus newest_status() const {
    std::shared_ptr<const WorkerStatus> newest;
    {
      const std::lock_guard lock(mutex_);
      newest = published_;
    }
    return *newest;
  }

  /// True while the worker plays or has commands to carry out or results to fetch.
  bool is_busy() const { return busy_; }

  /// Blocks until every command sent before is carried out.
  void wait_until_idle() {
    std::unique_lock lock(mutex_);
    idle_.wait(lock, [this, last = sent_] { return done_ >= last; });
  }

  std::array<FrameExchange, cloth::max_panes> frames;  ///< of each pane; a scene is pane 0

  // --- Called by the worker's thread ---

  /// Moves the commands received to the end of `waiting`; waits for one until `due`, or without a limit if
  /// `due` is empty.
  void receive(Commands& waiting, std::optional<Clock::time_point> due) {
    std::unique_lock lock(mutex_);
    const auto has_command = [this] { return !inbox_.empty(); };
    if (!due)
      wake_.wait(lock, stop, has_command);
    else if (*due > Clock::now())
      wake_.wait_until(lock, stop, *due, has_command);
    has_mail_ = false;
    waiting.splice(waiting.end(), inbox_);
  }

  /// Whether a command was sent and not received. Reads one atomic value, so it can be called before every
  /// step.
  bool has_mail() const { return has_mail_; }

  /// Whether such a command waits and `is` is true for the first one.
  template <class Predicate>
  bool next_is(Predicate is) const {
    const std::lock_guard lock(mutex_);
    return !inbox_.empty() && is(inbox_.front());
  }

  /// Queues a sample. When the queue is full (max_samples), the sample is lost and counted in the status.
  void deliver(const ChartSample& sample) { deliver(sample, samples_); }
  void deliver(const CompareSample& sample) { deliver(sample, pane_samples_); }

  /// Begins the results of a new run at the simulated time `time` (s): what was not fetched of the one before
  /// is deleted.
  void begin_run(double time) {
    {
      const std::lock_guard lock(mutex_);
      samples_.clear();
      pane_samples_.clear();
    }
    for (FrameExchange& frame : frames) frame.take();
    ++status.starts;
    restart_clock(time);
  }

  /// Makes a copy of `status` available to the window.
  void publish() {
    auto newest = std::make_shared<const WorkerStatus>(status);
    const std::lock_guard lock(mutex_);
    published_.swap(newest);  // the one before goes after the lock
  }

  /// `done` commands since the start are carried out; `busy`: results are still to come, even without further
  /// commands.
  void report_done(std::uint64_t done, bool busy) {
    const std::lock_guard lock(mutex_);
    busy_ = busy || !inbox_.empty();
    if (done_ == done) return;
    done_ = done;
    idle_.notify_all();
  }

  /// Begins to count simulated time from `time` (s).
  void restart_clock(double time) {
    pace.restart(time, Clock::now());
    meter.restart(time, Clock::now());
  }

  std::stop_token stop;  ///< requested when the worker is to end
  WorkerStatus status;   ///< the worker's own, see publish()
  WorkerPace pace;
  RateMeter meter;
  ContactChoice contact;
  Colouring colouring = Colouring::strain;
  std::uint64_t topology = 0;  ///< of the frames: another number for another cloth

 private:
  template <class Sample>
  void deliver(const Sample& sample, std::vector<Sample>& queue) {
    const std::lock_guard lock(mutex_);
    if (queue.size() < max_samples)
      queue.push_back(sample);
    else
      ++status.lost_samples;
  }

  mutable std::mutex mutex_;
  std::condition_variable_any wake_, idle_;
  Commands inbox_;
  std::vector<ChartSample> samples_;
  std::vector<CompareSample> pane_samples_;
  std::shared_ptr<const WorkerStatus> published_ = std::make_shared<const WorkerStatus>();
  std::uint64_t sent_ = 0, done_ = 0;  ///< commands
  std::atomic<bool> busy_{false}, has_mail_{false};
};

}  // namespace clothlab
