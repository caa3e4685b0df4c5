#include "kernels/shared_job.h"

#include <algorithm>
#include <chrono>

namespace cloth {
namespace {

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

/// The others have worked as long as the caller, each: shares are alike.
void ShareWatch::took(double now, int size, const WorkerTeam::Spent& spent) {
  spent_.working += spent.working, spent_.waiting += spent.waiting;
  if (spent_.working + spent_.waiting < watched) return;
  const bool pays = spent_.waiting < (size - 1) * spent_.working;
  spent_ = {};
  if (!pays) rests_until_ = now + next_rest_;
  next_rest_ = pays ? first_rest : std::min(2 * next_rest_, longest_rest);
}

WorkerTeam* SharedJob::begin() {
  is_watched_ = false;
  if (!team_ || use_ == ThreadUse::always) return team_;
  if (!watch_.shares(seconds_now())) return nullptr;
  is_watched_ = true, before_ = team_->spent();
  return team_;
}

void SharedJob::end() {
  if (!is_watched_) return;
  const WorkerTeam::Spent& now = team_->spent();
  watch_.took(seconds_now(), team_->size(), {now.working - before_.working, now.waiting - before_.waiting});
}

}  // namespace cloth
