// Runs one sweep at a time over all cores, in threads of its own at low priority. Its rows go to the sweep's
// folder, where whoever shows them reads them; the window polls the status. Only `wait` and the destructor
// wait for it.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <thread>

#include "sweep/run_sweep.h"

namespace clothlab {

/// A sweep that is begun, or one that goes on.
struct SweepOrder {
  std::filesystem::path folder;
  std::optional<cloth::SweepPlan> plan{};  ///< none: that of the folder goes on
};

struct SweepStatus {
  bool running = false;
  bool stopping = false;  ///< cancelled; the present points have not ended yet
  bool writing = false;   ///< all points are made; tables and pictures are written
  std::int64_t points = 0, done = 0;
  double elapsed = 0;          ///< s
  std::optional<double> left;  ///< estimated, s; none: no estimate yet
  std::string problem;         ///< why it could not run or write; empty: no error
};

class SweepRunner {
 public:
  SweepRunner() = default;
  ~SweepRunner();
  SweepRunner(const SweepRunner&) = delete;
  SweepRunner& operator=(const SweepRunner&) = delete;

  /// Precondition: nothing is running. `jobs`: points at once.
  void start(SweepOrder order, int jobs);
  void cancel();
  SweepStatus status() const;
  bool is_running() const { return status().running; }
  /// Blocks until it has ended and its folder is written. For tests and for closing.
  void wait();

 private:
  using Clock = std::chrono::steady_clock;
  void run(const SweepOrder& order, int jobs, const std::stop_token& stop);
  std::string carry_out(const SweepOrder& order, int jobs, const std::stop_token& stop);
  void note(std::int64_t done, std::int64_t points);

  mutable std::mutex mutex_;
  SweepStatus status_;
  Clock::time_point start_;
  std::int64_t earlier_ = -1;  ///< points that were there at the first note
  std::jthread thread_;
};

}  // namespace clothlab
