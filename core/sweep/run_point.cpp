#include "sweep/run_point.h"

#include <fmt/format.h>

#include <chrono>
#include <new>

#include "scene/scene_checks.h"
#include "simulation/memory_estimate.h"
#include "simulation/recorder.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_from(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Fewer need so little memory that looking for it would take longer than such a run's own start.
constexpr int particles_without_a_look = 20'000;

std::string one_line(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) text += (text.empty() ? "" : "; ") + problem.text();
  return text;
}

/// Of one point while it is run.
class PointRun {
 public:
  PointRun(const SweepPlan& plan, const StopTest& stop) : plan_(plan), stop_(stop) {
    for (const RunOutput& output : plan.outputs) {
      reducers_.emplace_back(output);
      auto found = std::find(sources_.begin(), sources_.end(), output.of);
      source_of_.push_back(static_cast<std::size_t>(found - sources_.begin()));
      if (found == sources_.end()) sources_.push_back(output.of);
    }
  }

  std::optional<PointRow> run(const SceneReading& reading, PointRow row) {
    row.scene = scene_hash(*reading.scene);
    if (!reading.problems.empty()) return ended(row, PointStatus::refused, one_line(reading.problems));
    const Scene& scene = *reading.scene;
    const auto time_step = resolved_time_step(scene);
    if (!time_step) return ended(row, PointStatus::refused, no_stable_step_text(scene));
    if (const auto rule = too_many_steps(scene.duration, *time_step))
      return ended(row, PointStatus::refused, *rule);
    const std::int64_t steps = steps_to_cover(scene.duration, *time_step);
    if (plan_.limits.steps > 0 && steps > plan_.limits.steps)
      return ended(row, PointStatus::limit_steps, fmt::format("the run would take {} steps", steps));
    if (scene.cloth.rows * scene.cloth.columns > particles_without_a_look)
      if (const auto problem = memory_problem(scene)) return ended(row, PointStatus::no_memory, *problem);
    RunOptions options;
    options.progress = [this](double) { return may_go_on(); };
    options.row = [this](const Simulation& simulation, const Measurement& measured) {
      add_row(simulation, measured);
    };
    return result_of(run_scene(scene, options).summary, row);
  }

 private:
  bool may_go_on() {
    if (is_to_stop(stop_)) return false;
    if (plan_.limits.wall > 0 && seconds_from(start_) > plan_.limits.wall) hit_wall_ = true;
    return !hit_wall_ && !hit_steps_;
  }

  void add_row(const Simulation& simulation, const Measurement& measured) {
    if (plan_.limits.steps > 0 && measured.step > plan_.limits.steps) hit_steps_ = true;
    const std::vector<double> values = output_values(sources_, simulation, measured);
    for (std::size_t k = 0; k < reducers_.size(); ++k) reducers_[k].add(measured.time, values[source_of_[k]]);
  }

  static std::optional<PointRow> ended(PointRow& row, PointStatus status, const std::string& cause) {
    row.status = status;
    row.cause = cause;
    return row;
  }

  std::optional<PointRow> result_of(const RunSummary& summary, PointRow& row) {
    row.steps = summary.count.steps;
    if (hit_steps_ || (plan_.limits.steps > 0 && row.steps > plan_.limits.steps)) {
      row.steps = plan_.limits.steps;  // where it was noticed is chance
      return ended(row, PointStatus::limit_steps, "the step was shortened until there were too many");
    }
    if (summary.divergence) {
      const bool unsolved = summary.divergence->solver_failed || summary.divergence->pinched;
      return ended(row, unsolved ? PointStatus::unsolvable : PointStatus::diverged,
                   describe(*summary.divergence));
    }
    if (hit_wall_)
      return ended(row, PointStatus::limit_wall, fmt::format("at t = {:.6g} s", summary.simulated));
    if (summary.status == Status::stopped) return std::nullopt;
    if (summary.rate_breach) row.cause = describe(*summary.rate_breach);
    for (std::size_t k = 0; k < reducers_.size(); ++k) row.outputs[k] = reducers_[k].result();
    return row;
  }

  const SweepPlan& plan_;
  const StopTest& stop_;
  Clock::time_point start_ = Clock::now();
  std::vector<OutputReducer> reducers_;
  std::vector<std::string> sources_;    ///< columns and measures, each once
  std::vector<std::size_t> source_of_;  ///< of each output
  bool hit_wall_ = false, hit_steps_ = false;
};

}  // namespace

std::optional<PointRow> run_point(const SweepPlan& plan, const SweepPoints& points, std::int64_t point,
                                  const StopTest& stop) {
  const Clock::time_point start = Clock::now();
  PointRow row{.point = point};
  row.outputs.assign(plan.outputs.size(), std::numeric_limits<double>::quiet_NaN());
  std::optional<PointRow> made;
  try {
    made = PointRun(plan, stop).run(points.scene(point), row);
  } catch (const std::bad_alloc&) {
    row.status = PointStatus::no_memory;
    row.cause = "there is not enough memory for this run";
    made = row;
  }
  if (made) made->wall = seconds_from(start);
  return made;
}

}  // namespace cloth
