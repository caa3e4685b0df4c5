#include "compare/ranking.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace cloth {
namespace {

/// From 1 upwards; equal values share a rank, and the next one leaves out as many.
template <class Value>
void rank(std::vector<PaneResult>& results, int PaneResult::*into, Value value) {
  for (PaneResult& result : results) {
    const std::optional<double> own = value(result);
    if (!own) continue;
    result.*into =
        1 + static_cast<int>(std::count_if(results.begin(), results.end(), [&](const PaneResult& other) {
          const std::optional<double> theirs = value(other);
          return theirs && *theirs < *own;
        }));
  }
}

PaneResult result_of(const LockStep& lockstep, std::size_t pane) {
  const Lane& lane = lockstep.lane(pane);
  PaneResult result{.name = lane.name,
                    .title = lane.title,
                    .method = lane.simulation->scene().integrator.method,
                    .notice = lane.notice,
                    .style = style_of(lockstep.comparison().panes[pane]),
                    .is_reference = lockstep.reference_lane() == pane,
                    .status = lane.divergence                      ? Status::diverged
                              : lane.index < lockstep.last_index() ? Status::stopped
                                                                   : Status::finished,
                    .divergence = lane.divergence,
                    .rate_breach = lane.simulation->rate_breach(),
                    .time_step = lane.simulation->time_step(),
                    .simulated = lane.state.time,
                    .wall = lane.wall,
                    .timed_from = lane.timed_from,
                    .count = lane.simulation->count(),
                    .max_strain = lane.max_strain,
                    .energy = lane.energy,
                    .rms = {},
                    .largest = {},
                    .rms_over_time = lockstep.rms_over_time(pane)};
  if (const std::string of_steps = describe(result.count); !of_steps.empty())
    result.notice += (result.notice.empty() ? "" : "; ") + of_steps;
  if (const Difference* difference = lockstep.difference(pane)) {
    result.rms = difference->rms;
    result.largest = difference->largest;
    result.particle = difference->particle;
    result.below_floor = lockstep.floor() && difference->rms < lockstep.floor()->rms;
  }
  return result;
}

}  // namespace

std::vector<PaneResult> results_of(const LockStep& lockstep) {
  std::vector<PaneResult> results;
  for (std::size_t i = 0; i < lockstep.pane_count(); ++i) results.push_back(result_of(lockstep, i));
  rank(results, &PaneResult::error_rank, [](const PaneResult& r) { return r.rms; });
  rank(results, &PaneResult::cost_rank, [](const PaneResult& r) {
    return r.divergence || !(r.simulated > 0) ? std::optional<double>() : r.cost();
  });
  return results;
}

std::vector<std::size_t> ranked(const std::vector<PaneResult>& results) {
  std::vector<std::size_t> order(results.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::size_t i) {
    const PaneResult& r = results[i];
    return std::tuple(r.divergence.has_value(), r.divergence ? -r.simulated : 0.0, !r.is_reference,
                      r.error_rank == 0, r.error_rank, r.cost_rank);
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return order;
}

std::string reference_text(const LockStep& lockstep) {
  const auto lane = lockstep.reference_lane();
  if (!lane) return "nothing";
  if (*lane < lockstep.pane_count())
    return fmt::format("pane {}: {}", lockstep.lane(*lane).name, lockstep.lane(*lane).title);
  return lockstep.lane(*lane).title;
}

}  // namespace cloth
