// The stability map of a scene: methods side by side over two parameters, each cell a run judged by its
// energy, with the predicted limits beside it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/shard.h"
#include "simulation/simulation.h"
#include "study/energy_verdict.h"
#include "study/study_axis.h"
#include "study/study_progress.h"

namespace cloth {

/// Grids with more rows or columns than this are run with this many, unless full size is asked for.
inline constexpr int study_grid = 16;

struct StabilityMap;

struct StabilityOptions {
  std::vector<std::string> methods{};
  StudyAxis x{}, y{};
  StabilityCriterion criterion{};
  bool full_size = false;
  int jobs = 1;  ///< cells at once, fewer where memory is short; no bit depends on it
  std::function<bool(const StudyProgress&)> progress{};  ///< between and within cells; false stops the study
  /// The map so far, after every finished cell and measured limit, from one thread at a time; the last is
  /// what is returned.
  std::function<void(const StabilityMap&)> partial{};
  StopTest stop{};  ///< asked between batches of steps; stops like `progress`
  /// The same map, not whole: its cells and measured limits are not run again.
  const StabilityMap* earlier = nullptr;
  Shard shard{};  ///< whose lines are run alone, see line_of
};

/// The step that is predicted to be the longest stable one, in s; 0: none is stable; infinity: any.
struct PredictedLimits {
  double predicted = 0;   ///< flat grid at rest, unbounded
  double guaranteed = 0;  ///< any shape
  double provot = 0;      ///< Provot's criterion, whatever the method
  double spectrum = 0;    ///< of this very grid with its pins, by Lanczos iteration at the start
};

enum class CellStatus { not_run, refused, run };

struct StabilityCell {
  double x = 0, y = 0;
  CellStatus status = CellStatus::not_run;
  RunClass run_class = RunClass::accurate;
  double time_step = 0;     ///< s
  double energy_ratio = 0;  ///< largest |energy error| / energy scale; infinity where it is not finite
  double growth_rate = 0;   ///< 1/s
  std::int64_t steps = 0;
  std::int64_t wanted_steps = 0;  ///< that the criterion asks for; more than the bound: cut short
  PredictedLimits limits{};
  std::string detail{};  ///< why it ended or was refused

  bool stable() const {
    return run_class == RunClass::accurate || run_class == RunClass::stable_but_inaccurate;
  }
};

/// Where one of the axes is the time step: what was measured at one value of the other.
struct MeasuredLimit {
  double other = 0;                     ///< the other axis' value
  double longest_stable = 0;            ///< s; 0: no step of the range was
  double shortest_unstable = infinity;  ///< s; infinity: no step of the range was
  bool stable_beyond = false;           ///< some longer step was stable again
  PredictedLimits limits{};

  bool bracketed() const { return longest_stable > 0 && shortest_unstable < infinity; }
  double middle() const;  ///< s, geometric; precondition: bracketed()
};

struct MethodMap {
  std::string method;
  std::vector<StabilityCell> cells;     ///< iy * x count + ix
  std::vector<MeasuredLimit> measured;  ///< ascending; empty where no axis is the time step
};

struct StabilityMap {
  Scene scene;               ///< as given
  StabilityOptions options;  ///< as run
  std::vector<double> x_values{}, y_values{};
  int rows = 0, columns = 0;  ///< of the grid that was run
  bool complete = true;       ///< false: stopped before the end
  std::vector<MethodMap> methods{};
  bool is_complete() const { return complete; }
};

/// What the axes and methods of `options` would make of the scene that breaks a rule. Empty: the map can be
/// run.
std::vector<Problem> find_problems(const Scene& scene, const StabilityOptions& options);

/// The methods that have a longest stable step: those for which there is a limit to see.
std::vector<std::string> methods_with_a_limit();

/// Time step over stiffness: 24 steps around the limits of `methods`, 12 stiffnesses from a tenth to ten
/// times the scene's. `methods` decide the range of steps.
StudyAxis default_time_axis(const Scene& scene, const std::vector<std::string>& methods);
StudyAxis default_stiffness_axis(const Scene& scene);

/// The scene of one cell: method and values set, fixed steps, the grid made smaller unless full_size.
/// Precondition: no problems.
Scene cell_scene(const Scene& scene, const StabilityOptions& options, const std::string& method, double x,
                 double y);

PredictedLimits predict_limits(const Scene& cell);

/// That the criterion asks for in runs of the cell's scene.
std::int64_t wanted_steps(const Scene& cell, double time_step, const StabilityCriterion& criterion);

/// One run, judged. `stop` is asked between batches of steps; after true the cell's status is not_run. No bit
/// depends on `threads`, which a step of a larger cloth may use.
StabilityCell run_cell(const Scene& cell, const StabilityCriterion& criterion, const StopTest& stop = {},
                       int threads = 1);

/// A line of the map: the cells of one method and one value of the other axis, along the time step where that
/// is an axis, else along x. Its number, method after method, of a cell or a measured limit.
std::int64_t line_of(const StabilityMap& map, std::size_t method, std::size_t cell);
std::int64_t line_of(const StabilityMap& map, std::size_t method, const MeasuredLimit& limit);

/// What will be run: axes and methods, no cells yet.
StabilityMap plan_stability_map(const Scene& scene, const StabilityOptions& options);

/// Deterministic: the same map for the same scene and options. Precondition: no problems.
StabilityMap run_stability_map(const Scene& scene, const StabilityOptions& options);

}  // namespace cloth
