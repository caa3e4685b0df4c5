#include "kernels/worker_team.h"

#include <cassert>
#include <chrono>
#include <new>
#include <system_error>
#if defined(__x86_64__) || defined(_M_X64)
#include <immintrin.h>
#endif

namespace cloth {
namespace {

/// Longer than what lies between two parallel loops of a step: to wake a thread costs tens of microseconds.
constexpr std::chrono::microseconds awake{1000};
/// Where threads have to share cores, who waits holds up whom it waits for.
constexpr std::chrono::microseconds awake_in_a_crowd{10};

std::atomic<int> hired{0};  ///< threads of all teams

std::chrono::microseconds time_awake() {
  static const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return cores == 0 || hired.load(std::memory_order_relaxed) < cores ? awake : awake_in_a_crowd;
}

void relax() {
#if defined(__x86_64__) || defined(_M_X64)
  _mm_pause();
#endif
}

/// Returns when `value` is no longer `old`: it changes soon, or it may take long.
template <class T>
void wait_for_change(const std::atomic<T>& value, T old) {
  const auto until = std::chrono::steady_clock::now() + time_awake();
  do {
    for (int k = 0; k < 64; ++k) {
      if (value.load(std::memory_order_acquire) != old) return;
      relax();
    }
  } while (std::chrono::steady_clock::now() < until);
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

void Milestone::reach(int number) {
  reached_.store(number, std::memory_order_release);
  reached_.notify_all();
}

void Milestone::await(int number) const {
  for (int reached = reached_.load(std::memory_order_acquire); reached < number;
       reached = reached_.load(std::memory_order_acquire))
    wait_for_change(reached_, reached);
}

WorkerTeam::WorkerTeam(int size) {
  assert(size >= 1);
  // Half of what can just be had leaves room for what the threads work on.
  for (int workers = size - 1; !hire(workers);) workers = static_cast<int>(workers_.size()) / 2, dismiss();
}

WorkerTeam::~WorkerTeam() {
  dismiss();
}

/// Whether all of them could be had.
bool WorkerTeam::hire(int workers) {
  try {
    workers_.reserve(static_cast<std::size_t>(workers));
    for (int share = 1; share <= workers; ++share) {
      workers_.emplace_back([this, share] { work(share); });
      hired.fetch_add(1, std::memory_order_relaxed);
    }
  } catch (const std::system_error&) {
    return false;
  } catch (const std::bad_alloc&) {
    return false;
  }
  return true;
}

void WorkerTeam::dismiss() {
  stops_ = true;
  job_number_.fetch_add(1, std::memory_order_release);
  job_number_.notify_all();
  for (std::thread& worker : workers_) worker.join();
  hired.fetch_sub(static_cast<int>(workers_.size()), std::memory_order_relaxed);
  workers_.clear();
  job_number_ = 0;
  stops_ = false;
}

void WorkerTeam::start(int shares, Function function, const void* context) {
  assert(shares <= size());
  shares_ = shares;
  if (shares == 1) return function(context, 0);
  if (shares < 1) return;
  function_ = function;
  context_ = context;
  at_work_.store(static_cast<int>(workers_.size()), std::memory_order_relaxed);
  job_number_.fetch_add(1, std::memory_order_release);
  job_number_.notify_all();
  const auto begun = std::chrono::steady_clock::now();
  function(context, 0);
  const auto waited = std::chrono::steady_clock::now();
  for (int left = at_work_.load(std::memory_order_acquire); left != 0;
       left = at_work_.load(std::memory_order_acquire))
    wait_for_change(at_work_, left);
  spent_.working += std::chrono::duration<double>(waited - begun).count();
  spent_.waiting += std::chrono::duration<double>(std::chrono::steady_clock::now() - waited).count();
}

void WorkerTeam::work(int share) {
  std::uint32_t seen = 0;  // no job starts before all are hired
  for (;;) {
    wait_for_change(job_number_, seen);
    seen = job_number_.load(std::memory_order_acquire);
    if (stops_) return;
    if (share < shares_) function_(context_, share);
    if (at_work_.fetch_sub(1, std::memory_order_acq_rel) == 1) at_work_.notify_one();
  }
}

}  // namespace cloth
