#include "kernels/thread_choice.h"

#include <algorithm>
#include <cassert>

namespace cloth {
namespace {

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

int ThreadChoice::next(int max_threads) {
  if (max_threads != max_threads_) *this = ThreadChoice{}, max_threads_ = max_threads;
  if (max_threads_ <= 1) return 1;
  if (at_ >= trial + hold_) {
    at_ = 0;
    hold_ = std::min(2 * hold_, longest_hold);
  }
  if (trying()) return tries_all() ? max_threads_ : 1;
  return chosen_;
}

void ThreadChoice::took(double seconds, int jobs) {
  assert(jobs <= at_once());
  if (max_threads_ <= 1) return;
  if (!trying()) {
    if (chosen_ > 1) watch_over(seconds, jobs);
    at_ += jobs;
    return;
  }
  if (at_ % block >= not_counted) (tries_all() ? together_ : alone_).push_back(seconds);
  if (++at_ == trial) decide();
}

void ThreadChoice::decide() {
  alone_median_ = median(alone_);
  chosen_ = median(together_) < worthwhile * alone_median_ ? max_threads_ : 1;
  alone_.clear();
  together_.clear();
  watched_ = 0, watched_jobs_ = 0;
}

/// A core that others want meanwhile shows soon: a thread that has to wait stops all of them.
void ThreadChoice::watch_over(double seconds, int jobs) {
  watched_ += seconds;
  watched_jobs_ += jobs;
  if (watched_jobs_ < watch || watched_ < watch_time) return;
  if (watched_ > watched_jobs_ * alone_median_) chosen_ = 1;
  watched_ = 0, watched_jobs_ = 0;
}

}  // namespace cloth
