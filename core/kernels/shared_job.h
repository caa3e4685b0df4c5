// Whether a job that is repeated shares its work among a team. It does, until the caller waits longer for the
// other threads than they spare it: another program has their cores. Then it keeps to one thread for a while.
//
//     WorkerTeam* const team = job.begin();   // null: one thread
//     in_shares(team, ...);
//     job.end();
//
// Precondition: results are bitwise the same for any number of threads.
#pragma once

#include "kernels/thread_choice.h"
#include "kernels/worker_team.h"

namespace cloth {

/// The rule. All times in s.
class ShareWatch {
 public:
  /// Whether the job at this time, on a clock that goes on, shares its work.
  bool shares(double now) const { return now >= rests_until_; }
  /// After a job that did, on a team of `size` threads, whose caller took `spent`.
  void took(double now, int size, const WorkerTeam::Spent& spent);

  /// Of parallel loops, before it judges: a single interruption of some milliseconds is not to end sharing.
  static constexpr double watched = 0.02;
  /// On one thread: after the first time that sharing did not pay, and twice as long each time, at most.
  static constexpr double first_rest = 0.1, longest_rest = 1.6;

 private:
  double rests_until_ = 0, next_rest_ = first_rest;
  WorkerTeam::Spent spent_;  ///< since the last judgement
};

class SharedJob {
 public:
  /// Null: one thread.
  void set_team(WorkerTeam* team, ThreadUse use) { team_ = team, use_ = use; }
  WorkerTeam* begin();
  void end();

 private:
  WorkerTeam* team_ = nullptr;
  ThreadUse use_ = ThreadUse::where_they_gain;
  ShareWatch watch_;
  bool is_watched_ = false;   ///< this job
  WorkerTeam::Spent before_;  ///< this job
};

}  // namespace cloth
