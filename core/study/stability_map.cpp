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
  MethodMap begun(const std::string& method) const;
  bool lay_out(MethodMap& map);
  bool run_cells(MethodMap& map);
  bool measure_limits(MethodMap& map);
  bool narrow(const std::string& method, MeasuredLimit& limit);
  bool is_mine(const MethodMap& map, std::size_t cell) const {
    const auto method = static_cast<std::size_t>(&map - map_.methods.data());
    return options_.shard.has(line_of(map_, method, cell));
  }
  PredictedLimits limits_beside(const MethodMap& map, double other) const;
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
  const std::vector<double>& other_values() const { return x_is_step() ? y_values_ : x_values_; }

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

/// A method's cells, those run that the map which goes on has, with its measured limits.
MethodMap MapRunner::begun(const std::string& name) const {
  MethodMap map{name, {}, {}};
  if (options_.earlier)
    for (const MethodMap& method : options_.earlier->methods)
      if (method.method == name) map = method;
  for (std::size_t k = map.cells.size(); k < x_values_.size() * y_values_.size(); ++k)
    map.cells.push_back({.x = x_values_[k % x_values_.size()], .y = y_values_[k / x_values_.size()]});
  return map;
}

/// Fills in what is known without running: the limits, and how long each cell will take.
bool MapRunner::lay_out(MethodMap& map) {
  for (std::size_t k = 0; k < map.cells.size(); ++k) {
    if (!is_mine(map, k)) continue;
    if (is_to_stop(options_.stop)) return false;
    StabilityCell& cell = map.cells[k];
    const Scene scene = cell_scene(scene_, options_, map.method, cell.x, cell.y);
    // A time step does not change them.
    cell.limits = k % x_values_.size() == 0 || !x_is_step() ? predict_limits(scene) : map.cells[k - 1].limits;
    if (cell.status != CellStatus::not_run) continue;
    cell.time_step = resolved_time_step(scene).value_or(0);
    cell.wanted_steps = cell.time_step > 0 ? wanted_steps(scene, cell.time_step, options_.criterion) : 0;
    work_ += expected_work(cell, options_.criterion);
    ++cells_;
  }
  for (MeasuredLimit& limit : map.measured) limit.limits = limits_beside(map, limit.other);
  return true;
}

bool MapRunner::run_cells(MethodMap& map) {
  for (std::size_t k = 0; k < map.cells.size(); ++k) {
    StabilityCell& cell = map.cells[k];
    if (!is_mine(map, k) || cell.status != CellStatus::not_run) continue;
    const PredictedLimits limits = cell.limits;
    const double work = expected_work(cell, options_.criterion);
    text_ = fmt::format("cell {} of {}", ++cell_, cells_);
    StabilityCell result = run_at(map.method, cell.x, cell.y);
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

/// Those of the last step that was run with a value of the other axis.
PredictedLimits MapRunner::limits_beside(const MethodMap& map, double other) const {
  const std::vector<double>& others = other_values();
  const auto k =
      static_cast<std::size_t>(std::lower_bound(others.begin(), others.end(), other) - others.begin());
  const std::size_t columns = x_values_.size(), rows = y_values_.size();
  return map.cells[x_is_step() ? k * columns + columns - 1 : (rows - 1) * columns + k].limits;
}

bool MapRunner::measure_limits(MethodMap& map) {
  const std::size_t columns = x_values_.size();
  const std::vector<double>& others = other_values();
  const std::vector<double>& steps = x_is_step() ? x_values_ : y_values_;
  for (std::size_t k = 0; k < others.size(); ++k) {
    if (!is_mine(map, x_is_step() ? k * columns : k)) continue;
    const auto at = std::ranges::lower_bound(map.measured, others[k], {}, &MeasuredLimit::other);
    if (at != map.measured.end() && at->other == others[k]) continue;
    MeasuredLimit limit{.other = others[k]};
    limit.limits = limits_beside(map, limit.other);
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
    map.measured.insert(at, limit);
    tell();
  }
  return true;
}

StabilityMap MapRunner::run() {
  map_ = plan_stability_map(scene_, options_);
  x_values_ = map_.x_values;
  y_values_ = map_.y_values;
  for (const std::string& method : options_.methods) map_.methods.push_back(begun(method));
  for (MethodMap& method : map_.methods) map_.complete = map_.complete && lay_out(method);
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

std::int64_t line_of(const StabilityMap& map, std::size_t method, std::size_t cell) {
  const std::size_t columns = map.x_values.size(), rows = map.y_values.size();
  const bool y_is_step = map.options.y.path == time_step_path;
  return static_cast<std::int64_t>(y_is_step ? method * columns + cell % columns
                                             : method * rows + cell / columns);
}

std::int64_t line_of(const StabilityMap& map, std::size_t method, const MeasuredLimit& limit) {
  const bool y_is_step = map.options.y.path == time_step_path;
  const std::vector<double>& others = y_is_step ? map.x_values : map.y_values;
  const auto place =
      static_cast<std::size_t>(std::lower_bound(others.begin(), others.end(), limit.other) - others.begin());
  return line_of(map, method, y_is_step ? place : place * map.x_values.size());
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
