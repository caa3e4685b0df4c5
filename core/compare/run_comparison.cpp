#include "compare/run_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "compare/comparison_recorder.h"

namespace cloth {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds flush_interval{200};

void gather(const LockStep& lockstep, ComparisonRun& run) {
  std::vector<PaneSeries>& series = run.series;
  const double time = lockstep.time_of(lockstep.index());
  for (std::size_t i = 0; i < series.size(); ++i) {
    const Lane& lane = lockstep.lane(i);
    if (!lane.going()) continue;
    series[i].time.push_back(time);
    series[i].energy_error.push_back(lane.measurement.energy_error());
    series[i].max_strain.push_back(lane.measurement.strain.maximum());
    if (const Difference* difference = lockstep.difference(i)) {
      series[i].difference_time.push_back(time);
      series[i].rms.push_back(difference->rms);
    }
  }
  if (const Difference* floor = lockstep.floor()) {
    run.floor_series.difference_time.push_back(time);
    run.floor_series.rms.push_back(floor->rms);
    run.floor = floor->rms;
    run.largest_floor = std::max(run.largest_floor, floor->rms);
  }
}

/// Panes meet at multiples of the record interval: one longer than the duration would carry them far beyond
/// it. As in a run, there are rows at the start and at the end then.
Comparison with_an_end(const Comparison& comparison) {
  Comparison result = comparison;
  result.scene.record.interval = std::min(result.scene.record.interval, result.scene.duration);
  return result;
}

void add_sentence(std::string& notice, const std::string& sentence) {
  if (!sentence.empty()) notice += (notice.empty() ? "" : "; ") + sentence;
}

/// The controlled reference and its check ask for the same rate as the panes.
void look_at_reference_rate(const LockStep& lockstep, ComparisonRun& run) {
  for (std::size_t i = lockstep.pane_count(); i < lockstep.lane_count(); ++i) {
    const Lane& lane = lockstep.lane(i);
    if (!lane.simulation->rate_breach()) continue;
    run.reference_rate_kept = false;
    add_sentence(run.notice, fmt::format("{} ({}): {}", lane.name, lane.title,
                                         describe(*lane.simulation->rate_breach())));
  }
}

void conclude(const LockStep& lockstep, ComparisonRun& run) {
  add_sentence(run.notice, uneven_intervals_text(run.comparison.scene));
  look_at_reference_rate(lockstep, run);
  run.panes = results_of(lockstep);
  run.reference = reference_text(lockstep);
  run.particles = lockstep.lane(0).simulation->system().size();
  run.columns = lockstep.lane(0).simulation->system().columns;
  run.simulated = lockstep.time_of(lockstep.index());
  const auto reference = lockstep.reference_lane();
  if (!reference) return;
  const Lane& lane = lockstep.lane(*reference);
  if (*reference == lockstep.pane_count()) {
    run.reference_wall = lane.wall;
    run.check = lockstep.lane(*reference + 1).title;
  }
  if (lane.divergence) run.reference_failure = describe(*lane.divergence);
}

}  // namespace

bool ComparisonRun::has_result() const {
  const bool any = std::any_of(panes.begin(), panes.end(), [](const PaneResult& p) { return !p.divergence; });
  return any && reference_failure.empty();
}

bool ComparisonRun::rate_is_kept() const {
  return reference_rate_kept &&
         std::none_of(panes.begin(), panes.end(), [](const PaneResult& p) { return p.rate_breach; });
}

ComparisonRun run_comparison(const Comparison& comparison, const ComparisonOptions& options) {
  LockStep lockstep(with_an_end(comparison));
  if (options.may_go_on) lockstep.set_stop_test([&] { return !options.may_go_on(); });
  ComparisonRun run;
  run.comparison = as_run(lockstep);
  run.threads = options.threads;
  run.series.resize(lockstep.pane_count());
  ComparisonRecorder recorder;
  const auto keep = [&](std::optional<IoError> error) {
    if (error && !run.io_error) run.io_error = std::move(error);
    return !run.io_error;
  };
  const bool on_disk = options.results || !options.folder.empty();
  const auto open = [&] {
    return options.results ? recorder.open(*options.results, lockstep)
                           : recorder.open(options.folder, lockstep);
  };
  const auto add_row = [&] {
    gather(lockstep, run);
    return !on_disk || keep(recorder.add_row(lockstep));
  };

  bool going = (!on_disk || keep(open())) && add_row();
  Clock::time_point flushed = Clock::now();
  for (std::int64_t k = 1; going && k <= lockstep.last_index() && !lockstep.all_stopped(); ++k) {
    if (!lockstep.advance(k, options.may_go_on, options.threads)) {
      run.stopped = true;
      break;
    }
    if (lockstep.all_stopped()) break;
    going = add_row();
    if (options.progress) options.progress(lockstep.time_of(k));
    if (on_disk && Clock::now() - flushed > flush_interval) {
      going = going && keep(recorder.flush());
      flushed = Clock::now();
    }
  }
  if (on_disk) keep(recorder.close());
  conclude(lockstep, run);
  return run;
}

}  // namespace cloth
