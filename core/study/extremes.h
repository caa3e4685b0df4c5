// Stiff and extreme cases: a fixed, named list, every method on each. A cell of the table is a finite result
// or a stop that names step, particle and cause.
//
//     for (const ExtremeCase& extreme : extreme_cases())
//       for (const std::string& method : integrator_names()) ExtremeCell cell = run_extreme(extreme, method);
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/shard.h"
#include "simulation/simulation.h"
#include "study/study_progress.h"

namespace cloth {

enum class ExtremeStatus {
  stable,
  not_converged,
  energy_growth,
  diverged,
  unreachable,
  refused,
  solver_failed
};

/// As files have it.
inline constexpr const char* extreme_status_names[] = {
    "stable", "not-converged", "energy-growth", "diverged", "unreachable", "refused", "solver-failed"};
inline const char* name_of(ExtremeStatus status) {
  return extreme_status_names[static_cast<std::size_t>(status)];
}

struct ExtremeCase {
  std::string name;     ///< "stiffness-1e3"
  std::string what;     ///< the scene and how it is started
  std::string reading;  ///< what a cell that is not stable means here
  Scene scene;          ///< of any method; without a time step: each method's own
  std::int64_t max_steps = 300;
  Preparation prepare = {};  ///< what a scene file cannot say
  /// Of the force, after which a cell ends whatever its steps: error control may need any number.
  std::int64_t max_evaluations = 100'000;
};

/// In the order of the table.
const std::vector<ExtremeCase>& extreme_cases();

/// Cases made of a scene, each pushed in one thing: its springs' stiffness, its step, its mass, its damping,
/// its wind, its deformation rate. A cell has as many steps as half of the scene's duration, at most 300.
std::vector<ExtremeCase> extreme_cases_of(const Scene& scene);

/// Of every random start in the list.
inline constexpr std::uint64_t extreme_seed = 19950517;

/// Of the energy that the scene can give: what a method may add before its cell says energy growth.
inline constexpr double growth_threshold = 0.05;

/// Of the largest speed: what the last iteration of a step may still change before its cell says not
/// converged.
inline constexpr double residual_threshold = 0.1;

struct ExtremeCell {
  std::string case_name, method;
  ExtremeStatus status = ExtremeStatus::stable;
  std::string detail;        ///< one sentence or a few facts
  double time_step = 0;      ///< s; 0 if refused
  std::int64_t steps = 0;    ///< that were accepted
  bool ended_early = false;  ///< for its evaluations
  double max_strain = 0;     ///< of all records
  double energy_ratio = 0;   ///< kinetic and elastic energy at the end over what the scene can give
  double wall = 0;           ///< s, of the run
};

/// Runs one cell: at most `max_steps` and `max_evaluations`. Energy growth: at the records of the second
/// half (there are some 50 of a run) the kinetic, elastic and gravity energies are in the mean above those of
/// the start and all works into the cloth by more than the threshold, losses by damping not counted.
/// `stop` is asked after every step, and within one that takes long; true ends the run. No bit depends on
/// `threads`, which a step of a larger cloth may use.
ExtremeCell run_extreme(const ExtremeCase& extreme, const std::string& method, const StopTest& stop = {},
                        int threads = 1);

/// Case after case, each with every method; an interrupted run, or a part of one, has fewer cells.
struct ExtremesTable {
  std::optional<Scene> scene;  ///< that the cases are made of; none: the fixed list
  std::vector<ExtremeCase> cases;
  std::vector<std::string> methods;
  std::vector<ExtremeCell> cells;

  /// Of a cell among all that there are to be.
  std::int64_t number_of(const ExtremeCell& cell) const;

  /// Null where it was not run.
  const ExtremeCell* cell(std::size_t extreme, std::size_t method) const;
  bool is_complete() const { return cells.size() == cases.size() * methods.size(); }
};

struct ExtremesOptions {
  std::optional<Scene> scene{};        ///< push this one; none: the fixed list
  std::vector<std::string> methods{};  ///< empty: all
  std::vector<std::string> cases{};    ///< empty: all
  int jobs = 1;                        ///< cells at once, fewer where memory is short; no bit depends on it
  std::function<bool(const StudyProgress&)> progress{};  ///< before each cell; false stops the study
  /// The table so far, after every cell, from one thread at a time; the last is what is returned.
  std::function<void(const ExtremesTable&)> partial{};
  StopTest stop{};  ///< asked after every step; half a cell is none
  /// The same table, not whole: its cells are not run again.
  const ExtremesTable* earlier = nullptr;
  Shard shard{};  ///< whose cells are run alone, by their numbers
};

/// The cases and methods that are asked for, in the list's order; no cells yet.
ExtremesTable empty_table(const ExtremesOptions& options);
ExtremesTable run_extremes(const ExtremesOptions& options);

}  // namespace cloth
