#include "study/validation/scene_validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/scene_cloth.h"
#include "simulation/recorder.h"
#include "simulation/rest_shape.h"
#include "simulation/time_step.h"
#include "study/refined_scene.h"
#include "study/run_output.h"

namespace cloth {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// Half, whole and finer ones, as far as the pins keep their places and grids have so many columns.
std::vector<int> grids_around(const Scene& scene) {
  const int own = scene.cloth.columns - 1, unit = cell_unit(scene);
  constexpr std::size_t count = 4;
  std::vector<int> cells;
  if (own % 2 == 0 && (own / 2) % unit == 0) cells.push_back(own / 2);
  for (int next = own; cells.size() < count; next *= 2) cells.push_back(next);
  while (cells.size() > 1 && broken_cells_rule(scene, cells)) cells.pop_back();
  return cells;
}

double nearest_distance(const Vec3& point, const std::vector<Vec3>& line) {
  double least = infinity;
  for (std::size_t k = 0; k + 1 < line.size(); ++k) {
    const Vec3 along = line[k + 1] - line[k];
    const double square = along.squaredNorm();
    const double part = square > 0 ? std::clamp((point - line[k]).dot(along) / square, 0.0, 1.0) : 0;
    least = std::min(least, (point - line[k] - part * along).norm());
  }
  return least;
}

/// At a place between ascending ones, on the straight lines between the values; beyond them the last value.
template <class Value>
Value between(const std::vector<double>& places, const std::vector<Value>& values, double at) {
  const auto above = std::lower_bound(places.begin(), places.end(), at);
  if (above == places.begin()) return values.front();
  if (above == places.end()) return values.back();
  const auto k = static_cast<std::size_t>(above - places.begin());
  const double part = (at - places[k - 1]) / (places[k] - places[k - 1]);
  return values[k - 1] + part * (values[k] - values[k - 1]);
}

/// From the first particle to the last, 0 to 1.
std::vector<double> arcs_of(const std::vector<Vec3>& line) {
  std::vector<double> arcs;
  for (std::size_t k = 0; k < line.size(); ++k)
    arcs.push_back(static_cast<double>(k) / static_cast<double>(line.size() - 1));
  return arcs;
}

void compare_profile(const SceneValidation& study, MeasuredRun& run) {
  std::vector<Vec3> seen = run.line;
  for (Vec3& point : seen)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (!study.data.has_axis[axis]) point[static_cast<Eigen::Index>(axis)] = 0;
  const double length = length_of_line(study.scene.measured->output, study.scene.cloth);
  double sum = 0;
  for (const Vec3& point : study.data.points) {
    const double distance = nearest_distance(point, seen);
    sum += distance * distance;
    run.largest = std::max(run.largest, distance / length);
  }
  run.value = std::sqrt(sum / static_cast<double>(study.data.points.size()));
  run.error = run.value / length;
}

void compare_history(const MeasuredData& data, MeasuredRun& run) {
  double sum = 0, size = 0;
  for (std::size_t k = 0; k < data.times.size(); ++k) {
    const double difference = std::abs(between(run.times, run.values, data.times[k]) - data.values[k]);
    sum += difference * difference;
    run.largest = std::max(run.largest, difference);
    size = std::max(size, std::abs(data.values[k]));
  }
  run.value = between(run.times, run.values, data.times.back());
  run.error = std::sqrt(sum / static_cast<double>(data.times.size())) / size;
  run.largest /= size;
}

/// What was found against what was measured.
void compare(const SceneValidation& study, MeasuredRun& run) {
  if (study.data.kind == MeasuredKind::profile) return compare_profile(study, run);
  if (study.data.kind == MeasuredKind::history) return compare_history(study.data, run);
  run.value = run.values.back();
  run.error = run.value / study.data.values.front() - 1;
  run.largest = std::abs(run.error);
}

/// Root mean square of how far two grids are from each other: at the particles of the coarsest grid, or at
/// the measured times.
double distance_between(const SceneValidation& study, const MeasuredRun& one, const MeasuredRun& other) {
  if (study.data.kind == MeasuredKind::value) return std::abs(one.value - other.value);
  double sum = 0;
  std::size_t count = 0;
  if (study.data.kind == MeasuredKind::history) {
    count = study.data.times.size();
    for (const double time : study.data.times)
      sum += std::pow(between(one.times, one.values, time) - between(other.times, other.values, time), 2);
  } else {
    const std::vector<double> places = arcs_of(study.runs.front().line);
    count = places.size();
    for (const double arc : places)
      sum += (between(arcs_of(one.line), one.line, arc) - between(arcs_of(other.line), other.line, arc))
                 .squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(count));
}

/// Reads off one state, or the rows of a run.
class MeasuredReader {
 public:
  MeasuredReader(const SceneValidation& study, MeasuredRun& run)
      : run_(run),
        output_(study.scene.measured->output),
        is_line_(is_line(output_)),
        reading_(parse_output(output_)) {}

  void add_row(const Simulation& simulation, const Measurement& row) {
    if (is_line_) return;
    reading_.add(simulation, row);
    run_.times.push_back(row.time);
    run_.values.push_back(reading_.result());
  }
  void end(const ClothSystem& system, const Vec3Field& position) {
    if (is_line_) run_.line = points_of_line(output_, system, position);
    if (!is_line_ && (run_.values.empty() || !std::isfinite(run_.values.back())))
      run_.failure = output_ + " has no value";
  }

 private:
  MeasuredRun& run_;
  const std::string output_;
  const bool is_line_;
  OutputReducer reading_;
};

/// False where it was stopped.
bool read_rest(const SceneValidation& study, Scene scene, const StopTest& stop, MeasuredRun& run) {
  const RestShape rest = find_rest(scene, {.stop = stop});
  if (is_to_stop(stop)) return false;
  run.failure = rest.failure;
  if (!rest.found) return true;
  if (!resolved_time_step(scene))
    scene.integrator.time_step = scene.record.interval;  // of no step that is taken
  const Simulation simulation(scene,
                              [&](ClothSystem&, ClothState& state) { state.position = rest.position; });
  MeasuredReader reader(study, run);
  reader.add_row(simulation, simulation.measure());
  reader.end(simulation.system(), rest.position);
  return true;
}

/// False where it was stopped.
bool read_end(const SceneValidation& study, const Scene& scene, const SceneValidationOptions& options,
              MeasuredRun& run) {
  run.failure = refusal_to_run(scene);
  if (!run.failure.empty()) return true;
  MeasuredReader reader(study, run);
  RunOptions of_run;
  of_run.threads = options.threads;
  of_run.row = [&](const Simulation& simulation, const Measurement& row) { reader.add_row(simulation, row); };
  const double before = static_cast<double>(study.runs.size()), all = static_cast<double>(study.cells.size());
  of_run.progress = [&](double time) {
    if (is_to_stop(options.stop)) return false;
    return !options.progress ||
           options.progress({(before + time / scene.duration) / all,
                             fmt::format("{}: {} cells, t = {:.3g} s", study.name, run.cells, time)});
  };
  const RunResult result = run_scene(scene, of_run);
  run.time_step = result.summary.time_step;
  if (result.summary.status == Status::stopped) return false;
  if (result.summary.divergence)
    run.failure = describe(*result.summary.divergence);
  else
    reader.end(make_cloth(scene), result.final_state.position);
  return true;
}

std::optional<MeasuredRun> run_on(const SceneValidation& study, int cells,
                                  const SceneValidationOptions& options) {
  const Scene scene = study.one_grid.empty() ? refined_scene(study.scene, cells) : study.scene;
  MeasuredRun run{.cells = cells, .rows = scene.cloth.rows, .columns = scene.cloth.columns};
  const bool is_whole = study.scene.measured->state == "rest" ? read_rest(study, scene, options.stop, run)
                                                              : read_end(study, scene, options, run);
  if (!is_whole) return std::nullopt;
  if (run.failure.empty()) compare(study, run);
  return run;
}

}  // namespace

double SceneValidation::order() const {
  if (runs.size() < 3) return no_number;
  const MeasuredRun &coarse = runs[runs.size() - 3], &middle = runs[runs.size() - 2], &fine = runs.back();
  for (const MeasuredRun* run : {&runs.front(), &coarse, &middle, &fine})
    if (!run->failure.empty()) return no_number;
  if (fine.cells * coarse.cells != middle.cells * middle.cells)
    return no_number;  // refined by another factor
  const double before = distance_between(*this, coarse, middle),
               after = distance_between(*this, middle, fine);
  return before > after && after > 0 ? std::log(before / after) / std::log(double(fine.cells) / middle.cells)
                                     : no_number;
}

bool SceneValidation::holds() const {
  const int judged = std::min(own_cells(), cells.back());
  return is_complete() && std::all_of(runs.begin(), runs.end(), [&](const MeasuredRun& run) {
           return run.failure.empty() &&
                  (run.cells < judged || std::abs(run.error) <= scene.measured->tolerance);
         });
}

std::vector<Problem> find_grid_problems(const Scene& scene, const std::vector<int>& cells) {
  if (cells.empty()) return {};
  if (const auto problem = refinement_problem(scene)) return {*problem};
  if (const auto rule = broken_cells_rule(scene, cells)) return {{"--cells", "", *rule}};
  return {};
}

SceneValidation plan_scene_validation(const std::string& name, const Scene& scene, MeasuredData data,
                                      const std::vector<int>& cells) {
  SceneValidation study{.name = name, .scene = scene, .data = std::move(data), .cells = cells};
  if (!cells.empty()) return study;
  if (const auto problem = refinement_problem(scene))
    study.cells = {study.own_cells()}, study.one_grid = problem->text();
  else
    study.cells = grids_around(scene);
  return study;
}

void run_scene_validation(SceneValidation& study, const SceneValidationOptions& options) {
  while (!study.is_complete()) {
    const int cells = study.cells[study.runs.size()];
    const double part = static_cast<double>(study.runs.size()) / static_cast<double>(study.cells.size());
    if (is_to_stop(options.stop)) return;
    if (options.progress && !options.progress({part, fmt::format("{}: {} cells", study.name, cells)})) return;
    auto run = run_on(study, cells, options);
    if (!run) return;
    study.runs.push_back(std::move(*run));
  }
}

}  // namespace cloth
