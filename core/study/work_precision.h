// Error against run time: every method over a ladder of steps, its errors against one reference, its time
// around the stepping loop alone.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/shard.h"
#include "simulation/simulation.h"
#include "study/order_estimate.h"
#include "study/reference_solution.h"
#include "study/step_ladder.h"
#include "study/study_progress.h"

namespace cloth {

struct WorkPrecision;

struct WorkPrecisionOptions {
  std::vector<std::string> methods;  ///< of integrator_names(); empty: all
  std::optional<double> horizon;     ///< s; none: default_horizon
  int repeats = 5;                   ///< timed ones; runs of less than 40 ms get up to four times as many
  int steps_per_method = 7;          ///< runs that must reach the horizon, if the budget lasts
  double budget = 200;  ///< estimated s, see estimated_seconds: what does not fit is refused and says so
  std::function<bool(const StudyProgress&)> progress;  ///< false stops the study; what is finished is kept
  /// The study so far: after the reference, every finished run and every timed repeat of one; the last is
  /// what is returned.
  std::function<void(const WorkPrecision&)> partial{};
  StopTest stop{};  ///< asked between batches of steps, the timed ones too; stops like `progress`
  /// The same study, not whole: its reference, runs and timings are not made again. Only where the states of
  /// the reference are lost and a run is left to measure is it solved once more.
  const WorkPrecision* earlier = nullptr;
  /// Whose methods are measured alone, by their place. Each may then use up the budget: what the other
  /// methods leave of it is known when all are together, so that a part may have runs that the whole study
  /// refuses.
  std::optional<Shard> shard{};
};

enum class RunStatus { stable, energy_growth, diverged, solver_failed, refused };
/// As files say it.
inline constexpr const char* run_status_names[] = {"stable", "energy-growth", "diverged", "solver-failed",
                                                   "refused"};
inline const char* name_of(RunStatus status) {
  return run_status_names[static_cast<std::size_t>(status)];
}

struct TimedSample {
  int repeat = 0, turn = 0;  ///< which repeat, and this run's place in its shuffled order
  double seconds = 0;
};

struct TimeSpread {
  double least = 0, lower_quartile = 0, median = 0, upper_quartile = 0;  ///< s; all 0: never timed
};

struct WorkPrecisionRun {
  int rung = 0;          ///< -1: beyond the stability limit
  double tolerance = 0;  ///< of error control; 0: none
  double time_step = 0;  ///< s; with error control the mean of the accepted ones
  std::int64_t steps = 0;
  StepCount count = {};
  std::int64_t limiter_iterations = 0;  ///< of the direct solver
  StateDifference error = {};           ///< only of runs that reached the horizon; else not a number
  double energy_error = 0;              ///< J, at the horizon
  RunStatus status = RunStatus::stable;
  std::string detail = {};  ///< where and why it stopped or was refused
  double estimated = 0;     ///< s
  std::vector<TimedSample> samples = {};
  TimeSpread time = {};

  bool reached_horizon() const { return status == RunStatus::stable || status == RunStatus::energy_growth; }
};

struct MethodStudy {
  StepLadder ladder;
  std::vector<WorkPrecisionRun> runs;  ///< from the longest step to the shortest
  OrderEstimate order, velocity_order;
};

struct WorkPrecision {
  Scene scene;  ///< with the limiter's tolerance at most 1e-6, so that it is below the errors of time
  int particles = 0;
  double diagonal = 0;  ///< m
  double horizon = 0;   ///< s
  int samples = 0;
  int repeats = 0, steps_per_method = 0;
  double budget = 0, estimated = 0;  ///< s
  ReferenceSolution reference;
  std::vector<MethodStudy> methods;
  int parts = 0;  ///< that processes of their own made and timed, see study_parts.h
  bool stopped = false;
  bool is_complete() const { return !stopped; }
};

/// What the counted work should take on a machine of today, in s: decides what fits the budget, the same way
/// on every machine. It is no measurement.
double estimated_seconds(int particles, const StepCount& count, std::int64_t limiter_iterations);

/// Fills in times and orders from the samples and errors of the runs.
void conclude(WorkPrecision& study);

/// The scene of one run, as it was run.
Scene scene_of(const WorkPrecision& study, const MethodStudy& method, const WorkPrecisionRun& run);

/// The scene as it is studied: the limiter's tolerance is below the errors of time.
Scene studied_scene(const Scene& scene);

/// Quartiles are interpolated.
TimeSpread spread_of(const std::vector<TimedSample>& samples);

/// The rule that a study with this horizon breaks, in words; nothing if it keeps them. It holds for a horizon
/// what holds for a run's duration.
std::optional<std::string> broken_horizon_rule(const Scene& scene, const std::vector<std::string>& methods,
                                               double horizon);

/// What will be studied: ladders without runs, and no reference yet.
WorkPrecision plan_work_precision(const Scene& scene, const WorkPrecisionOptions& options);

/// Preconditions: find_problems(scene) is empty; the methods are known. Where there is no reference
/// (`reference.failure`) there are no runs.
WorkPrecision study_work_precision(const Scene& scene, const WorkPrecisionOptions& options);

}  // namespace cloth
