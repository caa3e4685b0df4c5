// Grid convergence: outputs of a scene on finer and finer grids of the same sheet, and what they say of the
// grid without end.
//
//     const GridConvergence study = run_grid_convergence(scene, {.cells = {8, 16, 32}});
//     const Richardson found = richardson_of(study, 0);  // of the first output
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "io/shard.h"
#include "scene/scene.h"
#include "study/richardson.h"
#include "study/study_progress.h"

namespace cloth {

enum class GridRunStatus { finished, diverged, solver_failed, refused };
/// As files have it.
inline constexpr const char* grid_run_status_names[] = {"finished", "diverged", "solver-failed", "refused"};
inline const char* name_of(GridRunStatus status) {
  return grid_run_status_names[static_cast<std::size_t>(status)];
}

/// The scene on one grid.
struct GridRun {
  int cells = 0;              ///< across
  int rows = 0, columns = 0;  ///< particles
  double cell = 0;            ///< m, length of a cell across
  GridRunStatus status = GridRunStatus::finished;
  std::string detail = {};    ///< why it failed or was refused, or what is to be said of it
  double time_step = 0;       ///< s, at the start; 0: refused
  bool step_changed = false;  ///< "auto" has shortened it
  std::int64_t steps = 0;
  double end_time = 0;           ///< s
  double wall = 0;               ///< s, of stepping alone
  std::vector<double> values{};  ///< one of each output; not a number where there is none
};

struct GridConvergence {
  Scene scene;  ///< with the studied time as its duration
  std::vector<std::string> outputs;
  std::vector<int> cells;       ///< of the grids, ascending
  std::vector<GridRun> runs{};  ///< those that were made, in this order
  bool is_complete() const { return runs.size() == cells.size(); }
};

struct GridConvergenceOptions {
  std::vector<int> cells{};                              ///< empty: default_cells(scene)
  std::vector<std::string> outputs{};                    ///< empty: default_outputs()
  std::optional<double> time{};                          ///< s; none: the scene's duration
  int threads = 1;                                       ///< that a step may use; no bit depends on it
  std::function<bool(const StudyProgress&)> progress{};  ///< false stops the study
  /// The study so far, after every run; the last is what is returned.
  std::function<void(const GridConvergence&)> partial{};
  StopTest stop{};  ///< asked between batches of steps; half a run is none
  /// The same study, not whole: its runs are not made again.
  const GridConvergence* earlier = nullptr;
  Shard shard{};  ///< whose runs are made alone, by their place in `cells`
};

/// lowest_point, elastic_J
const std::vector<std::string>& default_outputs();

/// What keeps a study from being made, each with the option that it is about; see refined_scene.h and
/// run_output.h. Precondition: find_problems(scene) is empty.
std::vector<Problem> find_problems(const Scene& scene, const GridConvergenceOptions& options);

/// The study without its runs. Precondition of both: find_problems is empty.
GridConvergence plan_grid_convergence(const Scene& scene, const GridConvergenceOptions& options);
GridConvergence run_grid_convergence(const Scene& scene, const GridConvergenceOptions& options);

/// A run on a grid of the study, not made yet.
GridRun run_to_make(const GridConvergence& study, int cells);

/// The run on that grid; null where it was not made.
const GridRun* run_with(const GridConvergence& study, int cells);

/// The scene of one run, as it was run.
Scene scene_of(const GridConvergence& study, const GridRun& run);

/// An output's values on the first `count` grids that were run, without those that have none.
std::vector<GridValue> grid_values(const GridConvergence& study, std::size_t output, std::size_t count);

/// What these values say; without `count` all of them.
Richardson richardson_of(const GridConvergence& study, std::size_t output, std::size_t count = SIZE_MAX);

/// What in this scene is another thing on another grid, and what keeps values from being compared, a sentence
/// each.
std::vector<std::string> cautions_of(const GridConvergence& study);

}  // namespace cloth
