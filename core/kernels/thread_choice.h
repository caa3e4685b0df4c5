// Chooses between one thread and several for a job that is repeated many times. It times both while the
// program runs, because the faster choice depends on the size of the job, the machine and its other load.
//
//     const int threads = choice.next(max_threads);   // before the job
//     choice.took(seconds);                    // after it, where choice.wants_time()
//
// Up to at_once() consecutive jobs may be done and timed together: took(seconds, jobs).
//
// Precondition: results are bitwise the same for any number of threads.
#pragma once

#include <limits>
#include <vector>

namespace cloth {

/// Whether a team's threads are used for every job, or only while measured to be faster.
enum class ThreadUse { where_they_gain, always };

class ThreadChoice {
 public:
  /// How many threads the next job gets: 1 or `max_threads`.
  int next(int max_threads);
  /// How many jobs may be done together after the last call of next(): one during a trial, which times each.
  int at_once() const { return max_threads_ > 1 && trying() ? 1 : std::numeric_limits<int>::max(); }
  /// Whether the jobs must be timed and reported by took().
  bool wants_time() const { return max_threads_ > 1 && (trying() || chosen_ > 1); }
  /// Wall time in s of the jobs that followed the last call of next(), at most at_once() of them.
  void took(double seconds, int jobs = 1);

  /// Number of jobs in a trial, and from one trial to the next: first_hold at first, while caches are cold,
  /// then twice as many each time, up to longest_hold.
  static constexpr int trial = 48, first_hold = 96, longest_hold = 32 * first_hold;

 private:
  /// A trial alternates between one thread and all in blocks of jobs. The first jobs of each block are not
  /// counted: they are slower, because their data is in the caches of other cores.
  static constexpr int block = 8, not_counted = 2;
  /// Several threads are chosen if their median time is below this part of that of one thread; smaller gains
  /// are within the noise.
  static constexpr double worthwhile = 0.97;
  /// Several threads are compared with one again after so many jobs and so much time, so that a single
  /// interruption of some milliseconds does not end their use.
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
  std::vector<double> alone_, together_;  ///< s, times of the trial's jobs on one thread and on all
  double alone_median_ = 0;               ///< s, of one thread
  double watched_ = 0;                    ///< s, of the jobs since the last comparison
  int watched_jobs_ = 0;
};

}  // namespace cloth
