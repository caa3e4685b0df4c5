#include "study/grid_convergence.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/scene_checks.h"
#include "simulation/recorder.h"
#include "study/refined_scene.h"
#include "study/run_output.h"

namespace cloth {
namespace {

/// Of a run with so many cells, in any unit: particles times steps, which "auto" shortens with the cells.
double cost_of_run(const Scene& scene, int cells) {
  return std::pow(cells, scene.integrator.time_step ? 2 : 3);
}

/// The part of the study that is done when `done` runs and a part of the next one are.
double fraction_of(const GridConvergence& study, std::size_t done, double part) {
  double sum = 0, all = 0;
  for (std::size_t k = 0; k < study.cells.size(); ++k) {
    const double cost = cost_of_run(study.scene, study.cells[k]);
    all += cost;
    sum += k < done ? cost : k == done ? part * cost : 0;
  }
  return sum / all;
}

void note(GridRun& run, const std::string& sentence) {
  if (!sentence.empty()) run.detail += (run.detail.empty() ? "" : "; ") + sentence;
}

/// How the run went, from its summary.
void conclude(GridRun& run, const RunSummary& summary) {
  run.time_step = summary.time_step;
  run.step_changed = !summary.step_changes.empty();
  run.steps = summary.count.steps;
  run.end_time = summary.simulated;
  run.wall = summary.wall;
  if (summary.divergence) {
    run.status = summary.divergence->solver_failed ? GridRunStatus::solver_failed : GridRunStatus::diverged;
    note(run, describe(*summary.divergence));
  } else {
    note(run, summary.notice);
    note(run, describe(summary.step_changes));
  }
}

/// The run of that place in the study; nullopt where it was stopped.
std::optional<GridRun> run_grid(const GridConvergence& study, std::size_t place,
                                const GridConvergenceOptions& options) {
  const int cells = study.cells[place];
  GridRun run = run_to_make(study, cells);
  const Scene scene = refined_scene(study.scene, cells);
  run.detail = refusal_to_run(scene);
  if (!run.detail.empty()) {
    run.status = GridRunStatus::refused;
    return run;
  }
  std::vector<OutputReducer> readings;
  for (const std::string& output : study.outputs) readings.emplace_back(parse_output(output));
  RunOptions of_run;
  of_run.threads = options.threads;
  of_run.row = [&](const Simulation& simulation, const Measurement& row) {
    for (OutputReducer& reading : readings) reading.add(simulation, row);
  };
  of_run.progress = [&](double time) {
    if (is_to_stop(options.stop)) return false;
    return !options.progress ||
           options.progress({fraction_of(study, place, time / scene.duration),
                             fmt::format("{} x {} particles, t = {:.3g} s", run.rows, run.columns, time)});
  };
  const RunSummary summary = run_scene(scene, of_run).summary;
  if (summary.status == Status::stopped) return std::nullopt;
  conclude(run, summary);
  if (run.status == GridRunStatus::finished)
    for (std::size_t k = 0; k < readings.size(); ++k) run.values[k] = readings[k].result();
  return run;
}

void caution_of_springs(const Scene& scene, std::vector<std::string>& cautions) {
  if (!scene.springs) return;
  cautions.emplace_back(
      "Springs in N/m: inside the sheet the stiffness of the cloth is the same on every grid, but springs "
      "and "
      "masses at its edges count whole, which is an error of first order in the cells.");
  if (scene.springs->flexion > 0)
    cautions.emplace_back(
        "springs.flexion is a stiffness between next but one particles: the resistance to bending that it "
        "gives falls with the square of the cells, so that what bending decides has no limit.");
}

void caution_of_particles(const Scene& scene, std::vector<std::string>& cautions) {
  std::vector<std::string> of_particles;
  if (scene.damping && *scene.damping > 0) of_particles.emplace_back("damping");
  if (scene.air && scene.air->drag > 0) of_particles.emplace_back("air.drag");
  if (scene.air && scene.air->skin_friction > 0) of_particles.emplace_back("air.skin_friction");
  if (!of_particles.empty())
    cautions.push_back(
        fmt::format("{} {} per particle: a grid with four times the particles has four times "
                    "as much of it, so that what it decides has no limit.",
                    fmt::join(of_particles, ", "), of_particles.size() == 1 ? "is" : "are"));
}

}  // namespace

const std::vector<std::string>& default_outputs() {
  static const std::vector<std::string> outputs{"lowest_point", "elastic_J"};
  return outputs;
}

std::vector<Problem> find_problems(const Scene& scene, const GridConvergenceOptions& options) {
  if (const auto problem = refinement_problem(scene)) return {*problem};
  std::vector<Problem> problems;
  const auto add = [&](const char* option, const std::optional<std::string>& rule) {
    if (rule) problems.push_back({option, "", *rule});
  };
  add("--cells", broken_cells_rule(scene, options.cells.empty() ? default_cells(scene) : options.cells));
  if (!options.outputs.empty()) add("--output", broken_outputs_rule(options.outputs, output_sources(scene)));
  if (options.time) {
    Scene timed = scene;
    timed.duration = *options.time;
    for (const Problem& problem : find_problems(timed)) add("--time", problem.text());
  }
  return problems;
}

GridConvergence plan_grid_convergence(const Scene& scene, const GridConvergenceOptions& options) {
  GridConvergence study;
  study.scene = scene;
  study.scene.duration = options.time.value_or(scene.duration);
  study.cells = options.cells.empty() ? default_cells(scene) : options.cells;
  study.outputs = options.outputs.empty() ? default_outputs() : options.outputs;
  return study;
}

const GridRun* run_with(const GridConvergence& study, int cells) {
  const auto found = std::ranges::find(study.runs, cells, &GridRun::cells);
  return found == study.runs.end() ? nullptr : &*found;
}

GridRun run_to_make(const GridConvergence& study, int cells) {
  const Scene refined = refined_scene(study.scene, cells);
  GridRun run{.cells = cells, .rows = refined.cloth.rows, .columns = refined.cloth.columns};
  run.cell = refined.cloth.width / cells;
  run.values.assign(study.outputs.size(), std::numeric_limits<double>::quiet_NaN());
  return run;
}

GridConvergence run_grid_convergence(const Scene& scene, const GridConvergenceOptions& options) {
  GridConvergence study = plan_grid_convergence(scene, options);
  if (options.earlier) study.runs = options.earlier->runs;
  for (std::size_t place = 0; place < study.cells.size(); ++place) {
    const int cells = study.cells[place];
    if (!options.shard.has(static_cast<std::int64_t>(place)) || run_with(study, cells)) continue;
    if (is_to_stop(options.stop)) return study;
    if (options.progress &&
        !options.progress({fraction_of(study, place, 0), fmt::format("{} cells across", cells)}))
      return study;
    auto run = run_grid(study, place, options);
    if (!run) return study;
    study.runs.insert(std::ranges::lower_bound(study.runs, cells, {}, &GridRun::cells), std::move(*run));
    if (options.partial) options.partial(study);
  }
  return study;
}

Scene scene_of(const GridConvergence& study, const GridRun& run) {
  Scene scene = refined_scene(study.scene, run.cells);
  if (!run.step_changed) scene.integrator.time_step = run.time_step;  // else no one step repeats the run
  return scene;
}

std::vector<GridValue> grid_values(const GridConvergence& study, std::size_t output, std::size_t count) {
  std::vector<GridValue> values;
  for (std::size_t k = 0; k < std::min(count, study.runs.size()); ++k)
    if (const GridRun& run = study.runs[k]; std::isfinite(run.values[output]))
      values.push_back({run.cell, run.values[output]});
  return values;
}

Richardson richardson_of(const GridConvergence& study, std::size_t output, std::size_t count) {
  return richardson(grid_values(study, output, count));
}

std::vector<std::string> cautions_of(const GridConvergence& study) {
  std::vector<std::string> cautions;
  caution_of_springs(study.scene, cautions);
  caution_of_particles(study.scene, cautions);
  if (!study.scene.integrator.time_step)
    cautions.emplace_back(
        "The step is auto, shorter on finer grids: the orders are those of cells and step together.");
  else
    cautions.emplace_back(
        "Every grid takes the same step: the error of the step stays in every value and in the limit.");
  double first = 0, last = 0;
  for (const GridRun& run : study.runs)
    if (run.status == GridRunStatus::finished)
      first = first > 0 ? std::min(first, run.end_time) : run.end_time, last = std::max(last, run.end_time);
  if (last - first > 1e-9 * last)
    cautions.push_back(
        fmt::format("The runs do not end at the same time, but from {:.6g} to {:.6g} s, because their steps "
                    "do not divide "
                    "it: choose a time that is a whole number of record intervals.",
                    first, last));
  return cautions;
}

}  // namespace cloth
