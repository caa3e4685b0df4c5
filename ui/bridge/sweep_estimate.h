// How long a sweep would take: a timed run of one of its points, and the steps that the others take. It is
// made beside the window.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "bridge/replaced_thread.h"
#include "sweep/sweep_plan.h"

namespace clothlab {

struct SweepEstimate {
  std::int64_t points = 0;
  double point = 0;          ///< s of one core, the mean of the points
  double whole = 0;          ///< s, over all jobs
  std::int64_t refused = 0;  ///< of the points that were looked at
  std::int64_t looked_at = 0;
};

/// Over so many points at once. nullopt where `stop` ended it. Runs one point for a quarter of a second at
/// most.
std::optional<SweepEstimate> estimate_sweep(const cloth::SweepPlan& plan, int jobs,
                                            const std::stop_token& stop);

class SweepEstimator {
 public:
  /// A new question takes the place of the one before. Does not wait.
  void ask(cloth::SweepPlan plan, int jobs);
  void forget();
  /// The answer to the last question, once.
  std::optional<SweepEstimate> take();

 private:
  struct Question {
    std::mutex mutex;
    std::optional<SweepEstimate> answer;
  };
  std::shared_ptr<Question> last_;
  ReplacedThread thread_;
};

}  // namespace clothlab
