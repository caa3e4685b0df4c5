// What passes between the window and a worker's thread: commands in, samples and status out. The window never
// waits: the lock is held only while something changes hands, and no frame passes here (see FrameExchange).
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

#include "bridge/worker_pace.h"
#include "bridge/worker_status.h"
#include "io/text_file.h"

namespace clothlab {

/// The base of a worker that owns what it computes and a thread for it.
template <class CommandType, class SampleType, class StatusType>
class Worker {
 public:
  using Command = CommandType;
  using Sample = SampleType;
  using Status = StatusType;
  static constexpr std::size_t most_samples = 1 << 18;  ///< an hour at 60 a second

  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void send(Command command) {
    {
      const std::lock_guard lock(mutex_);
      inbox_.push_back(std::move(command));
      ++sent_;
      busy_ = true;
      has_mail_ = true;
    }
    wake_.notify_one();
  }

  /// Every sample since the last call, in order.
  std::vector<Sample> take_samples() {
    const std::lock_guard lock(mutex_);
    return std::exchange(samples_, {});
  }

  /// The newest; copied without the lock.
  Status status() const {
    std::shared_ptr<const Status> newest;
    {
      const std::lock_guard lock(mutex_);
      newest = published_;
    }
    return *newest;
  }

  /// True while fetching is worth while: playing, or something is waiting to be done or fetched.
  bool is_busy() const { return busy_; }

  /// Blocks until every command sent before is in force. For tests and for closing; the window never calls
  /// it.
  void wait_until_idle() {
    std::unique_lock lock(mutex_);
    idle_.wait(lock, [this, last = sent_] { return done_ >= last; });
  }

 protected:  // for the worker's thread
  using Clock = WorkerPace::Clock;

  Worker() = default;
  ~Worker() = default;

  /// The commands that have come; waits for one until `due`, or for as long as it takes.
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

  /// Whether a command waits: cheap enough to be asked before every step.
  bool has_mail() const { return has_mail_; }

  /// Whether a command waits that `is` is true for, in front of all others.
  template <class Predicate>
  bool next_is(Predicate is) const {
    const std::lock_guard lock(mutex_);
    return !inbox_.empty() && is(inbox_.front());
  }

  /// A sample is lost where the window has not fetched any for very long.
  void deliver(const Sample& sample) {
    const std::lock_guard lock(mutex_);
    if (samples_.size() < most_samples)
      samples_.push_back(sample);
    else
      ++status_.lost_samples;
  }

  /// Those that were not fetched.
  void drop_samples() {
    const std::lock_guard lock(mutex_);
    samples_.clear();
  }

  /// `status_` as it is now.
  void publish() {
    auto newest = std::make_shared<const Status>(status_);
    const std::lock_guard lock(mutex_);
    published_.swap(newest);  // the one before goes after the lock
  }

  /// `done` commands since the start are in force; `busy`: there is more to come than what waits here.
  void report_done(std::uint64_t done, bool busy) {
    const std::lock_guard lock(mutex_);
    busy_ = busy || !inbox_.empty();
    if (done_ == done) return;
    done_ = done;
    idle_.notify_all();
  }

  /// From now on simulated time runs from `time`, in s.
  void restart_clock(double time) {
    pace_.restart(time, Clock::now());
    meter_.restart(time, Clock::now());
  }
  void set_speed(double factor, double time) {
    status_.speed = factor;
    pace_.set_speed(factor, time, Clock::now());
  }

  /// Nothing if nothing is recorded.
  virtual void end_recording() = 0;
  /// What a write to the recording gave: an error ends it.
  void note_record(const std::optional<cloth::IoError>& error) {
    if (!error) return;
    status_.recording_error = error->text();
    end_recording();
  }
  /// What the end of the recording gave. The first error is the one to be shown.
  void note_end(const std::optional<cloth::IoError>& error) {
    if (error && status_.recording_error.empty()) status_.recording_error = error->text();
  }

  Status status_;
  WorkerPace pace_;
  RateMeter meter_;
  Clock::time_point last_frame_{};

 private:
  mutable std::mutex mutex_;
  std::condition_variable_any wake_, idle_;
  std::vector<Command> inbox_;
  std::vector<Sample> samples_;
  std::shared_ptr<const Status> published_ = std::make_shared<const Status>();
  std::uint64_t sent_ = 0, done_ = 0;  ///< commands
  std::atomic<bool> busy_{false}, has_mail_{false};
};

}  // namespace clothlab
