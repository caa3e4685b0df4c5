// Exchanges data between the window's thread and a worker's thread: commands in, samples and status out. The
// window never waits for a computation: the mutex is held only while data are moved. Frames pass through
// FrameExchange instead.
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

#include "bridge/worker_commands.h"
#include "bridge/worker_pace.h"
#include "bridge/worker_status.h"
#include "io/text_file.h"

namespace clothlab {

/// The base of a worker that owns a computation and the thread for it. Public members are called by the
/// window's thread, protected ones by the worker's thread.
template <class SampleType>
class Worker {
 public:
  using Sample = SampleType;
  static constexpr std::size_t max_samples = 1 << 18;  ///< more than an hour at 60 samples a second

  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

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

  /// Every sample since the last call, in order.
  std::vector<Sample> take_samples() {
    const std::lock_guard lock(mutex_);
    return std::exchange(samples_, {});
  }

  /// The newest status; copied outside the lock.
  WorkerStatus status() const {
    std::shared_ptr<const WorkerStatus> newest;
    {
      const std::lock_guard lock(mutex_);
      newest = published_;
    }
    return *newest;
  }

  /// True while the worker plays or has commands to carry out or results to fetch.
  bool is_busy() const { return busy_; }

  /// Blocks until every command sent before is carried out. For tests and for closing; the running window
  /// never calls it.
  void wait_until_idle() {
    std::unique_lock lock(mutex_);
    idle_.wait(lock, [this, last = sent_] { return done_ >= last; });
  }

 protected:  // called on the worker's thread
  using Clock = WorkerPace::Clock;

  Worker() = default;
  ~Worker() = default;

  /// The commands received; waits for one until `due`, or without a limit if `due` is empty.
  std::vector<Command> receive(const std::stop_token& stop, std::optional<Clock::time_point> due) {
    std::unique_lock lock(mutex_);
    const auto has_command = [this] { return !inbox_.empty(); };
    if (!due)
      wake_.wait(lock, stop, has_command);
    else if (*due > Clock::now())
      wake_.wait_until(lock, stop, *due, has_command);
    has_mail_ = false;
    return std::exchange(inbox_, {});
  }

  /// Calls `round` again and again until the thread is to stop, and once more then: whatever was sent before
  /// is carried out.
  template <class Round>
  void repeat(const std::stop_token& stop, Round round) {
    for (bool last = false; !last;) {
      last = stop.stop_requested();
      round();
    }
  }

  /// Whether a command waits. Reads one atomic value, so it can be called before every step.
  bool has_mail() const { return has_mail_; }

  /// Whether a command waits and `is` is true for the first one.
  template <class Predicate>
  bool next_is(Predicate is) const {
    const std::lock_guard lock(mutex_);
    return !inbox_.empty() && is(inbox_.front());
  }

  /// Queues a sample. When the queue is full (max_samples), the sample is lost and counted in the status.
  void deliver(const Sample& sample) {
    const std::lock_guard lock(mutex_);
    if (samples_.size() < max_samples)
      samples_.push_back(sample);
    else
      ++status_.lost_samples;
  }

  /// Deletes the samples that were not fetched.
  void drop_samples() {
    const std::lock_guard lock(mutex_);
    samples_.clear();
  }

  /// Makes a copy of `status_` available to the window.
  void publish() {
    auto newest = std::make_shared<const WorkerStatus>(status_);
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
    pace_.restart(time, Clock::now());
    meter_.restart(time, Clock::now());
  }
  void set_speed(double factor, double time) {
    status_.speed = factor;
    pace_.set_speed(factor, time, Clock::now());
  }

  /// Ends the recording; does nothing if there is none.
  virtual void end_recording() = 0;
  /// Handles the result of a write to the recording: an error is stored in the status and ends the recording.
  void note_record(const std::optional<cloth::IoError>& error) {
    if (!error) return;
    status_.recording_error = error->text();
    end_recording();
  }
  /// Handles the result of ending the recording. The status keeps the first error.
  void note_end(const std::optional<cloth::IoError>& error) {
    if (error && status_.recording_error.empty()) status_.recording_error = error->text();
  }

  WorkerStatus status_;
  WorkerPace pace_;
  RateMeter meter_;
  Clock::time_point last_frame_{};

 private:
  mutable std::mutex mutex_;
  std::condition_variable_any wake_, idle_;
  std::vector<Command> inbox_;
  std::vector<Sample> samples_;
  std::shared_ptr<const WorkerStatus> published_ = std::make_shared<const WorkerStatus>();
  std::uint64_t sent_ = 0, done_ = 0;  ///< commands
  std::atomic<bool> busy_{false}, has_mail_{false};
};

}  // namespace clothlab
