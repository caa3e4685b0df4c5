// How the panes of a comparison came out, and in which order.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/lockstep.h"

namespace cloth {

struct PaneResult {
  std::string name, title, method, notice;
  int style = 0;  ///< of style_of_series
  bool is_reference = false;
  Status status = Status::finished;
  std::optional<Divergence> divergence;
  std::optional<RateBreach> rate_breach;
  double time_step = 0;   ///< s
  double simulated = 0;   ///< s, up to the last common time
  double wall = 0;        ///< s, of stepping alone, since `timed_from`
  double timed_from = 0;  ///< s of simulated time; another than 0 where a run was taken over
  StepCount count;
  double max_strain = 0;                ///< largest of all common times
  EnergyAccount energy;                 ///< up to the last common time
  std::optional<double> rms, largest;   ///< m, from the reference at the last common time
  int particle = 0;                     ///< that has the largest
  bool below_floor = false;             ///< `rms` is less than the reference's own from its check
  std::optional<double> rms_over_time;  ///< m, over particles and common times; of a stopped pane until then
  int error_rank = 0, cost_rank = 0;    ///< from 1; equal values share one; 0: not ranked

  /// s for each simulated second
  double cost() const { return simulated > timed_from ? wall / (simulated - timed_from) : 0; }
  double evaluations_each_second() const {  ///< of simulated time
    return simulated > 0 ? static_cast<double>(count.force_evaluations) / simulated : 0;
  }
};

/// In the order of the panes. Ranked by error is who has a difference at the end, by cost who got there.
std::vector<PaneResult> results_of(const LockStep& lockstep);

/// Indices of `results` as a table lists them: the reference pane first, then by error, then by cost; panes
/// that stopped come last, the one that got furthest first.
std::vector<std::size_t> ranked(const std::vector<PaneResult>& results);

/// What errors were measured against: "Dormand-Prince 5(4), tolerance 1e-11", "pane B: Verlet", "nothing".
std::string reference_text(const LockStep& lockstep);

}  // namespace cloth
