// A team of threads for parallel loops that are repeated many times. Between two jobs the threads spin for a
// short time, because the next step of a simulation usually follows within microseconds, and then sleep: at
// once where there are more threads than cores.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace cloth {

/// A counter of the progress of one thread, on which other threads wait for its results.
class alignas(64) Milestone {
 public:
  /// Resets the counter to 0. Call it before the job.
  void begin() { reached_.store(0, std::memory_order_relaxed); }
  /// Called by the owning thread only. What it wrote before is visible to threads that have awaited `number`
  /// or a smaller one (release and acquire).
  void reach(int number);
  /// Returns when `number` has been reached.
  void await(int number) const;

 private:
  std::atomic<int> reached_{0};
};

class WorkerTeam {
 public:
  /// The caller of run() counts as one of the `size` threads. The team is smaller if the system cannot start
  /// so many threads. Precondition: size >= 1.
  explicit WorkerTeam(int size);
  ~WorkerTeam();
  WorkerTeam(const WorkerTeam&) = delete;
  WorkerTeam& operator=(const WorkerTeam&) = delete;

  int size() const { return static_cast<int>(workers_.size()) + 1; }

  /// s, of the caller in all jobs of several shares so far.
  struct Spent {
    double working = 0;  ///< on its own shares
    double waiting = 0;  ///< for those of the others
  };
  const Spent& spent() const { return spent_; }

  /// Calls job(share) for each share in [0, shares), each on its own thread, and returns when all are done.
  /// Preconditions: shares <= size(); only one thread calls it at a time; job does not throw.
  template <class Job>
  void run(int shares, const Job& job) {
    start(
        shares, [](const void* context, int share) { (*static_cast<const Job*>(context))(share); }, &job);
  }

 private:
  using Function = void (*)(const void*, int);
  void start(int shares, Function function, const void* context);
  void work(int share);
  bool hire(int workers);
  void dismiss();

  Function function_ = nullptr;
  const void* context_ = nullptr;
  int shares_ = 0;
  bool stops_ = false;
  Spent spent_;
  alignas(64) std::atomic<std::uint32_t> job_number_{0};
  alignas(64) std::atomic<int> at_work_{0};
  std::vector<std::thread> workers_;
};

}  // namespace cloth
