#include "bridge/fit_runner.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cassert>
#include <chrono>

#include "bridge/worker_pace.h"
#include "io/process.h"

namespace clothlab {
namespace {

constexpr int fit_priority = 10;  // of nice(2)

}  // namespace

FitRunner::~FitRunner() {
  cancel();
  wait();
}

void FitRunner::start(cloth::IdentifyPlan plan) {
  assert(!is_running());
  wait();
  {
    const std::lock_guard lock(mutex_);
    status_ = {};
    status_.running = true;
    result_.reset();
  }
  thread_ = std::jthread(
      [this, plan = std::move(plan)](const std::stop_token& stop) mutable { run(std::move(plan), stop); });
}

void FitRunner::cancel() {
  {
    const std::lock_guard lock(mutex_);
    status_.stopping = status_.running;
  }
  thread_.request_stop();
}

void FitRunner::wait() {
  if (thread_.joinable()) thread_.join();
}

FitRunStatus FitRunner::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::shared_ptr<const FitOutcome> FitRunner::take() {
  const std::lock_guard lock(mutex_);
  return std::move(result_);
}

void FitRunner::run(cloth::IdentifyPlan plan, const std::stop_token& stop) {
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), fit_priority);  // its threads inherit it
  const auto start = std::chrono::steady_clock::now();
  std::string problem;
  std::shared_ptr<FitOutcome> outcome;
  try {
    plan.stop = [&stop] { return stop.stop_requested(); };
    plan.options.progress = [&](const cloth::FitProgress& progress) {
      const std::lock_guard lock(mutex_);
      status_.runs = progress.evaluations;
      status_.chi_squared = progress.chi_squared;
      status_.elapsed = seconds(std::chrono::steady_clock::now() - start);
      return true;
    };
    cloth::FitAccount account = cloth::identify(plan);
    plan.stop = {};
    plan.options.progress = {};
    outcome = std::make_shared<FitOutcome>(FitOutcome{std::move(plan), std::move(account)});
  } catch (...) {
    problem = cloth::failure_in_hand().text;
  }
  const std::lock_guard lock(mutex_);
  result_ = std::move(outcome);
  status_.problem = std::move(problem);
  status_.running = status_.stopping = false;
  status_.elapsed = seconds(std::chrono::steady_clock::now() - start);
}

}  // namespace clothlab
