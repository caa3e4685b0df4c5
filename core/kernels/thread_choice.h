// Decides whether a job that is repeated many times runs on one thread or on several. It times both while the
// program runs, since the answer depends on the size of the job, the machine and its other load.
//
//     const int threads = choice.next(max_threads);   // before the job
//     choice.took(seconds);                    // after it, where choice.wants_time()
//
// Jobs that follow each other may be done as one, up to at_once() of them: took(seconds, jobs).
//
// It may only be used where the result is the same to the bit for any number of threads.
#pragma once

#include <limits>
#include <vector>

namespace cloth {

/// Whether a team's threads are used for every job, or only while they are seen to gain.
enum class ThreadUse { where_they_gain, always };

class ThreadChoice {
 public:
  /// How many threads the next job gets: 1 or `max_threads`.
  int next(int max_threads);
  /// How many jobs may follow the last call of next() as one: a trial tells them apart.
  int at_once() const { return max_threads_ > 1 && trying() ? 1 : std::numeric_limits<int>::max(); }
  /// Whether took() wants to know how long the jobs lasted.
  bool wants_time() const { return max_threads_ > 1 && (trying() || chosen_ > 1); }
  /// Wall time in s of the jobs that followed the last call of next(), at most at_once() of them.
  void took(double seconds, int jobs = 1);

  /// Jobs of a trial, and between two trials: few at first, when nothing is warm yet, then twice as many each
  /// time up to the most.
  static constexpr int trial = 48, first_hold = 96, longest_hold = 32 * first_hold;

 private:
  /// A trial takes turns between one thread and all, in blocks, since a job that has just moved between
  /// cores does not show what it costs; the first jobs of a block are not counted.
  static constexpr int block = 8, not_counted = 2;
  /// Several threads must gain so much to be taken: as much again is noise.
  static constexpr double worthwhile = 0.97;
  /// Jobs, and the time that they took, after which several threads are compared with what one took: one
  /// interruption of some milliseconds is no reason to give them up.
  static constexpr int watch = 32;
  static constexpr double watch_time = 0.02;  ///< s

  bool trying() const { return at_ < trial; }
  bool tries_all() const { return (at_ / block) % 2 == 1; }
  void decide();
  void watch_over(double seconds, int jobs);

  int max_threads_ = 1;
  int at_ = 0;  ///< jobs since the trial began
  int hold_ = first_hold;
  int chosen_ = 1;
  std::vector<double> alone_, together_;  ///< s, of the trial's jobs
  double alone_median_ = 0;               ///< s
  double watched_ = 0;                    ///< s, of the jobs since the last comparison
  int watched_jobs_ = 0;
};

}  // namespace cloth
