// Fits parameters to measured values in a thread of its own, at low priority, its runs over all cores, into a
// folder. The window polls status and result. Only `wait` and the destructor wait for it.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <thread>

#include "study/identify/fit_folder.h"

namespace clothlab {

struct FitOrder {
  std::filesystem::path folder;  ///< that of `clothlab-cli identify --out`; an earlier fit of the same model
                                 ///< there hands its runs on
  cloth::IdentifyPlan plan;
  std::filesystem::path measured;  ///< the table that was read; it is never replaced
};

struct FitRunStatus {
  bool running = false, stopping = false;
  bool writing = false;  ///< fitted; its folder is being written
  std::size_t runs = 0;
  double chi_squared = cloth::infinity;  ///< the lowest so far
  std::vector<double> values{};          ///< there, of the plan's varied parameters
  double elapsed = 0;                    ///< s
  std::string problem;                   ///< why there is no result, or no folder; empty: no error
};

class FitRunner {
 public:
  FitRunner() = default;
  ~FitRunner();
  FitRunner(const FitRunner&) = delete;
  FitRunner& operator=(const FitRunner&) = delete;

  /// Preconditions: nothing is running, and cloth::find_problems(order.plan) is empty. Where the folder
  /// cannot be had nothing is run.
  void start(FitOrder order);
  void cancel();
  FitRunStatus status() const;
  bool is_running() const { return status().running; }
  /// The result since the last call; null if there is none.
  std::shared_ptr<const cloth::FitAccount> take();
  void wait();

 private:
  void run(FitOrder order, const std::stop_token& stop);
  std::string carry_out(FitOrder& order, const std::stop_token& stop);

  mutable std::mutex mutex_;
  FitRunStatus status_;
  std::shared_ptr<const cloth::FitAccount> result_;
  std::jthread thread_;
};

}  // namespace clothlab
