// A team of threads that run one job together, many times. Between jobs they spin for a moment, since the
// next step of a simulation follows within microseconds, and then sleep.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace cloth {

/// The progress of one thread of a job, for others that need its results.
class alignas(64) Milestone {
 public:
  /// Before the job.
  void begin() { reached_.store(0, std::memory_order_relaxed); }
  /// By the one thread whose milestone it is. Who awaits `number`, or one before, sees what came before this.
  void reach(int number);
  /// Returns when `number` has been reached.
  void await(int number) const;

 private:
  std::atomic<int> reached_{0};
};

class WorkerTeam {
 public:
  /// The caller of run() is one of the `size` threads. Where the system gives fewer threads, or has no
  /// address space for their stacks, the team is smaller. Precondition: size >= 1.
  explicit WorkerTeam(int size);
  ~WorkerTeam();
  WorkerTeam(const WorkerTeam&) = delete;
  WorkerTeam& operator=(const WorkerTeam&) = delete;

  int size() const { return static_cast<int>(workers_.size()) + 1; }

  /// job(share) for every share in [0, shares), each on a thread of its own, and returns when all are done.
  /// Precondition: shares <= size(), and no two threads call it at once. Jobs must not throw.
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
  alignas(64) std::atomic<std::uint32_t> job_number_{0};
  alignas(64) std::atomic<int> at_work_{0};
  std::vector<std::thread> workers_;
};

}  // namespace cloth
