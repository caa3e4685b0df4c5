// What passes between the window and a worker's thread: commands in, samples and status out. The window never
// waits: the lock is held only while something changes hands, and no frame passes here (see FrameExchange).
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

namespace clothlab {

template <class Command, class Sample, class Status>
class WorkerChannel {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t most_samples = 1 << 18;  ///< an hour at 60 a second

  // --- The window's side ---

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
      newest = status_;
    }
    return *newest;
  }

  /// True while fetching is worth while.
  bool is_busy() const { return busy_; }

  /// Blocks until every command sent before is in force.
  void wait_until_idle() {
    std::unique_lock lock(mutex_);
    idle_.wait(lock, [this, last = sent_] { return done_ >= last; });
  }

  // --- The worker's side ---

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

  /// False: the window has not fetched for so long that this one is lost.
  bool deliver(const Sample& sample) {
    const std::lock_guard lock(mutex_);
    if (samples_.size() >= most_samples) return false;
    samples_.push_back(sample);
    return true;
  }

  /// Those that were not fetched.
  void drop_samples() {
    const std::lock_guard lock(mutex_);
    samples_.clear();
  }

  void publish(const Status& status) {
    auto newest = std::make_shared<const Status>(status);
    const std::lock_guard lock(mutex_);
    status_.swap(newest);  // the one before goes after the lock
  }

  /// `done` commands since the start are in force; `busy`: there is more to come than what waits here.
  void settle(std::uint64_t done, bool busy) {
    const std::lock_guard lock(mutex_);
    busy_ = busy || !inbox_.empty();
    if (done_ == done) return;
    done_ = done;
    idle_.notify_all();
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable_any wake_, idle_;
  std::vector<Command> inbox_;
  std::vector<Sample> samples_;
  std::shared_ptr<const Status> status_ = std::make_shared<const Status>();
  std::uint64_t sent_ = 0, done_ = 0;  ///< commands
  std::atomic<bool> busy_{false}, has_mail_{false};
};

}  // namespace clothlab
