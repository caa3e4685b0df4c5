// The cells of a study, several at once: each on a thread of its own, in the study's order as far as they are
// begun. What they share, and whoever is told of them, is for one thread at a time.
//
//     StudyTeam team({.jobs = options.jobs, .stop = options.stop, .progress = options.progress});
//     team.run(missing.size(), [&](std::size_t k) {
//       Cell cell = run_cell(missing[k], [&] { return team.is_stopped(); }, team.threads());
//       if (team.is_stopped()) return false;  // half a cell is none
//       const auto lock = team.alone();
//       table.insert(std::move(cell));
//       if (options.partial) options.partial(table);
//       return true;
//     });
//
// Cells end in any order; their values do not depend on it, nor on the number of jobs.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <mutex>

#include "study/study_progress.h"

namespace cloth {

/// A cloth of so many particles steps as fast with one thread.
inline constexpr int most_particles_alone = 256;

class StudyTeam {
 public:
  struct Options {
    int jobs = 1;     ///< threads in all
    int at_once = 0;  ///< cells, where that is to be fewer, as for their memory; 0: as many as jobs
    StopTest stop{};
    std::function<bool(const StudyProgress&)> progress{};  ///< false stops the study
  };
  explicit StudyTeam(Options options);

  /// Calls make(0), ..., make(cells - 1), which say whether their cell was made to its end. True where all
  /// were. After a stop no more are begun; an exception stops the others and is passed on when all have
  /// ended.
  bool run(std::size_t cells, const std::function<bool(std::size_t)>& make);

  /// From any thread: whether cells are to end.
  bool is_stopped() const { return stopped_ || is_to_stop(options_.stop); }

  /// That a cell which begins now may step with: one, and more where fewer cells than jobs are left.
  int threads() const;

  /// Held while what cells share is read or changed.
  [[nodiscard]] std::unique_lock<std::mutex> alone() { return std::unique_lock(mutex_); }

  /// Precondition: within alone().
  void report(const StudyProgress& progress);

 private:
  const Options options_;
  std::mutex mutex_;
  std::atomic<bool> stopped_ = false;
  std::atomic<std::size_t> left_ = 0;  ///< cells that have not ended
};

}  // namespace cloth
