// Fits parameters to measured values in a thread of its own, at low priority, its runs over all cores. The
// window polls status and result. Only `wait` and the destructor wait for it.
#pragma once

#include <memory>
#include <mutex>
#include <thread>

#include "study/identify/identify.h"

namespace clothlab {

struct FitOutcome {
  cloth::IdentifyPlan plan;
  cloth::FitAccount account;
};

struct FitRunStatus {
  bool running = false, stopping = false;
  std::size_t runs = 0;
  double chi_squared = cloth::infinity;  ///< the lowest so far
  double elapsed = 0;                    ///< s
  std::string problem;                   ///< why there is no result; empty: no error
};

class FitRunner {
 public:
  FitRunner() = default;
  ~FitRunner();
  FitRunner(const FitRunner&) = delete;
  FitRunner& operator=(const FitRunner&) = delete;

  /// Preconditions: nothing is running, and cloth::find_problems(plan) is empty.
  void start(cloth::IdentifyPlan plan);
  void cancel();
  FitRunStatus status() const;
  bool is_running() const { return status().running; }
  /// The result since the last call; null if there is none.
  std::shared_ptr<const FitOutcome> take();
  void wait();

 private:
  void run(cloth::IdentifyPlan plan, const std::stop_token& stop);

  mutable std::mutex mutex_;
  FitRunStatus status_;
  std::shared_ptr<const FitOutcome> result_;
  std::jthread thread_;
};

}  // namespace clothlab
