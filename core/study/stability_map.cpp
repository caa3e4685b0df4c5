#include "study/stability_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "integrators/registry.h"
#include "measure/stability_limit.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

constexpr int batches_between_reports = 16;  // of how far it has come
constexpr int limit_halvings = 5;            // of the bracket between two cells

/// Work of a cell, in steps: a run beyond the limit soon ends.
double expected_work(const StabilityCell& cell, const StabilityCriterion& criterion) {
  const double steps = static_cast<double>(std::min<std::int64_t>(cell.wanted_steps, criterion.max_steps));
  return cell.time_step > 1.05 * cell.limits.spectrum ? 0.2 * steps : steps;
}

/// Goes through the cells, keeps count of the work, and stops when told to.
class MapRunner {
 public:
  MapRunner(const Scene& scene, const StabilityOptions& options) : scene_(scene), options_(options) {}

  StabilityMap run();

 private:
  bool lay_out(MethodMap& map);
  bool run_cells(MethodMap& map);
  bool measure_limits(MethodMap& map);
  bool narrow(const std::string& method, MeasuredLimit& limit);
  const MethodMap* earlier(const MethodMap& map) const;
  PredictedLimits limits_beside(const MethodMap& map, std::size_t k) const;
  StabilityCell run_at(const std::string& method, double x, double y);
  bool is_stopped() {
    return is_to_stop(options_.stop) || (++batches_ % batches_between_reports == 0 && !report());
  }
  void tell() const {
    if (options_.partial) options_.partial(map_);
  }
  bool report() { return !options_.progress || options_.progress({std::min(1.0, done_ / work_), text_}); }

  bool x_is_step() const { return options_.x.path == time_step_path; }
  bool y_is_step() const { return options_.y.path == time_step_path; }

  const Scene& scene_;
  const StabilityOptions& options_;
  std::vector<double> x_values_, y_values_;
  double work_ = 0, done_ = 0;
  std::int64_t batches_ = 0;
  std::size_t cells_ = 0, cell_ = 0;  ///< of all methods; the one that is run
  std::string text_ = "laying out the map";
  StabilityMap map_;
};

StabilityCell MapRunner::run_at(const std::string& method, double x, double y) {
  StabilityCell cell = run_cell(cell_scene(scene_, options_, method, x, y), options_.criterion,
                                [this] { return is_stopped(); });
  cell.x = x;
  cell.y = y;
  return cell;
}

/// Fills in what is known without running: the limits, and how long each cell will take.
bool MapRunner::lay_out(MethodMap& map) {
  for (const double y : y_values_) {
    if (is_to_stop(options_.stop)) return false;
    PredictedLimits row_limits;  // a time step does not change them
    for (std::size_t ix = 0; ix < x_values_.size(); ++ix) {
      const Scene scene = cell_scene(scene_, options_, map.method, x_values_[ix], y);
      StabilityCell cell{.x = x_values_[ix], .y = y};
      if (ix == 0 || !x_is_step()) row_limits = predict_limits(scene);
      cell.limits = row_limits;
      cell.time_step = resolved_time_step(scene).value_or(0);
      cell.wanted_steps = cell.time_step > 0 ? wanted_steps(scene, cell.time_step, options_.criterion) : 0;
      work_ += expected_work(cell, options_.criterion);
      map.cells.push_back(std::move(cell));
      ++cells_;
    }
  }
  return true;
}

/// The same method of the map that goes on, if there is one.
const MethodMap* MapRunner::earlier(const MethodMap& map) const {
  if (!options_.earlier) return nullptr;
  for (const MethodMap& method : options_.earlier->methods)
    if (method.method == map.method) return &method;
  return nullptr;
}

bool MapRunner::run_cells(MethodMap& map) {
  const MethodMap* before = earlier(map);
  for (std::size_t k = 0; k < map.cells.size(); ++k) {
    StabilityCell& cell = map.cells[k];
    const PredictedLimits limits = cell.limits;
    const double work = expected_work(cell, options_.criterion);
    const bool is_known =
        before && k < before->cells.size() && before->cells[k].status != CellStatus::not_run;
    text_ = fmt::format("cell {} of {}", ++cell_, cells_);
    StabilityCell result = is_known ? before->cells[k] : run_at(map.method, cell.x, cell.y);
    if (result.status == CellStatus::not_run) return false;
    result.limits = limits;
    cell = std::move(result);
    done_ += work;
    tell();
    if (!report()) return false;
  }
  return true;
}

/// Halves the ratio between the last stable and the first unstable cell a few times.
bool MapRunner::narrow(const std::string& method, MeasuredLimit& limit) {
  for (int k = 0; k < limit_halvings && limit.bracketed(); ++k) {
    const double step = limit.middle();
    const StabilityCell cell =
        x_is_step() ? run_at(method, step, limit.other) : run_at(method, limit.other, step);
    if (cell.status == CellStatus::not_run) return false;
    (cell.stable() ? limit.longest_stable : limit.shortest_unstable) = step;
  }
  return true;
}

/// Those of the last step that was run with the other axis' value `k`.
PredictedLimits MapRunner::limits_beside(const MethodMap& map, std::size_t k) const {
  const std::size_t columns = x_values_.size(), rows = y_values_.size();
  return map.cells[x_is_step() ? k * columns + columns - 1 : (rows - 1) * columns + k].limits;
}

bool MapRunner::measure_limits(MethodMap& map) {
  const std::size_t columns = x_values_.size();
  const std::vector<double>& others = x_is_step() ? y_values_ : x_values_;
  const std::vector<double>& steps = x_is_step() ? x_values_ : y_values_;
  const MethodMap* before = earlier(map);
  for (std::size_t k = 0; k < others.size(); ++k) {
    if (before && k < before->measured.size()) {
      map.measured.push_back(before->measured[k]);
      map.measured.back().limits = limits_beside(map, k);
      continue;
    }
    MeasuredLimit limit{.other = others[k]};
    limit.limits = limits_beside(map, k);
    for (std::size_t s = 0; s < steps.size(); ++s) {
      const StabilityCell& cell = map.cells[x_is_step() ? k * columns + s : s * columns + k];
      if (cell.status != CellStatus::run) continue;
      if (!cell.stable())
        limit.shortest_unstable = std::min(limit.shortest_unstable, steps[s]);
      else if (steps[s] < limit.shortest_unstable)
        limit.longest_stable = steps[s];
      else
        limit.stable_beyond = true;
    }
    if (!narrow(map.method, limit)) return false;
    map.measured.push_back(limit);
    tell();
  }
  return true;
}

StabilityMap MapRunner::run() {
  map_ = plan_stability_map(scene_, options_);
  x_values_ = map_.x_values;
  y_values_ = map_.y_values;
  for (const std::string& method : options_.methods) {
    map_.methods.push_back({method, {}, {}});
    map_.complete = map_.complete && lay_out(map_.methods.back());
  }
  const bool has_limits = x_is_step() || y_is_step();
  if (has_limits) work_ *= 1.2;  // for the limits' own runs
  work_ = std::max(work_, 1.0);
  for (MethodMap& method : map_.methods) {
    map_.complete = map_.complete && run_cells(method) && (!has_limits || measure_limits(method));
    if (!map_.complete) break;
  }
  tell();
  return std::move(map_);
}

}  // namespace

double MeasuredLimit::middle() const {
  return std::sqrt(longest_stable * shortest_unstable);
}

std::vector<std::string> methods_with_a_limit() {
  std::vector<std::string> names;
  for (const std::string& name : integrator_names())
    if (!stable_at_every_step(name)) names.push_back(name);
  return names;
}

StudyAxis default_stiffness_axis(const Scene& scene) {
  const double stiffness = has_stiffness(scene) ? leading_stiffness(scene) : 1;
  return {.path = all_stiffnesses_path,
          .low = stiffness / 10,
          .high = stiffness * 10,
          .count = 12,
          .scale = AxisScale::logarithmic};
}

StudyAxis default_time_axis(const Scene& scene, const std::vector<std::string>& methods) {
  constexpr double negligible =
      0.05;  // of the longest limit: such a method would stretch the axis for itself
  const double omega = largest_frequency(scene);
  const double reference = omega > 0 ? 2 / omega : scene.record.interval;
  double shortest = reference, longest = reference;
  for (const std::string& method : methods) {
    Scene fixed = scene;
    fixed.integrator.method = method;
    fixed.integrator.tolerance = 0;
    const double limit = stable_step(method, fixed).value_or(0);
    if (!(limit > negligible * reference) || !std::isfinite(limit)) continue;
    shortest = std::min(shortest, limit);
    longest = std::max(longest, limit);
  }
  // A tenth and ten times the stiffness move a limit by the root of ten.
  const double reach = 1.6 * std::sqrt(10.0);
  return {.path = time_step_path,
          .low = shortest / reach,
          .high = longest * reach,
          .count = 24,
          .scale = AxisScale::logarithmic};
}

std::vector<Problem> find_problems(const Scene& scene, const StabilityOptions& options) {
  std::vector<Problem> problems;
  if (options.x.path == options.y.path)
    return {{.path = options.y.path, .value = {}, .rule = "is on both axes", .place = "--y"}};
  for (const auto& [axis, option] : {std::pair{&options.x, "--x"}, std::pair{&options.y, "--y"}})
    for (const std::string& method : options.methods)
      for (const double value : {axis->low, axis->high}) {
        Scene edited = scene;
        edited.integrator.method = method;
        std::vector<Problem> found;
        if (const auto problem = set_number(edited, axis->path, value, option))
          found.push_back(*problem);
        else
          found = find_problems(edited);
        for (Problem& problem : found) {
          if (problem.place.empty()) problem.place = option;
          const auto same = [&](const Problem& other) { return other.text() == problem.text(); };
          if (std::none_of(problems.begin(), problems.end(), same)) problems.push_back(problem);
        }
      }
  return problems;
}

StabilityMap plan_stability_map(const Scene& scene, const StabilityOptions& options) {
  StabilityMap map{.scene = scene, .options = options};
  map.options.progress = {};
  map.options.partial = {};
  map.options.stop = {};
  map.options.earlier = nullptr;
  map.x_values = values_of(options.x);
  map.y_values = values_of(options.y);
  const Scene example =
      cell_scene(scene, options, options.methods.front(), map.x_values.front(), map.y_values.front());
  map.rows = example.cloth.rows;
  map.columns = example.cloth.columns;
  return map;
}

StabilityMap run_stability_map(const Scene& scene, const StabilityOptions& options) {
  return MapRunner(scene, options).run();
}

}  // namespace cloth
