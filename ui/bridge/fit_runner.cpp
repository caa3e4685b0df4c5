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

void FitRunner::start(FitOrder order) {
  assert(!is_running());
  wait();
  {
    const std::lock_guard lock(mutex_);
    status_ = {};
    status_.running = true;
    result_.reset();
  }
  thread_ = std::jthread(
      [this, order = std::move(order)](const std::stop_token& stop) mutable { run(std::move(order), stop); });
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

std::shared_ptr<const cloth::FitAccount> FitRunner::take() {
  const std::lock_guard lock(mutex_);
  return std::move(result_);
}

/// What went wrong; empty: nothing.
std::string FitRunner::carry_out(FitOrder& order, const std::stop_token& stop) {
  const auto start = std::chrono::steady_clock::now();
  cloth::FitFolder folder;
  if (const auto error = folder.begin(order.folder, order.plan, {order.measured})) return error->text();
  order.plan.runs = folder.runs();
  order.plan.stop = [&stop] { return stop.stop_requested(); };
  order.plan.options.progress = [&](const cloth::FitProgress& progress) {
    const std::lock_guard lock(mutex_);
    status_.runs = progress.evaluations;
    status_.chi_squared = progress.chi_squared;
    status_.values = progress.values;
    status_.elapsed = seconds(std::chrono::steady_clock::now() - start);
    return true;
  };
  const auto account = std::make_shared<const cloth::FitAccount>(cloth::identify(order.plan));
  {
    const std::lock_guard lock(mutex_);
    result_ = account;
    status_.writing = true;
  }
  const auto error = folder.end(order.plan, *account);
  return error ? error->text() : std::string();
}

void FitRunner::run(FitOrder order, const std::stop_token& stop) {
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), fit_priority);  // its threads inherit it
  std::string problem;
  try {
    problem = carry_out(order, stop);
  } catch (...) {
    problem = cloth::failure_in_hand().text;
  }
  const std::lock_guard lock(mutex_);
  status_.problem = std::move(problem);
  status_.running = status_.stopping = status_.writing = false;
}

}  // namespace clothlab
