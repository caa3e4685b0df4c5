#include "study/stability_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "integrators/registry.h"
#include "measure/stability_limit.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "simulation/memory_estimate.h"
#include "simulation/time_step.h"
#include "study/study_team.h"

namespace cloth {
namespace {

constexpr int batches_between_reports = 16;  // of how far it has come
constexpr int limit_halvings = 5;            // of the bracket between two cells

/// Work of a cell, in steps: a run beyond the limit soon ends.
double expected_work(const StabilityCell& cell, const StabilityCriterion& criterion) {
  const double steps = static_cast<double>(std::min<std::int64_t>(cell.wanted_steps, criterion.max_steps));
  return cell.time_step > 1.05 * cell.limits.spectrum ? 0.2 * steps : steps;
}

/// Of the corners of the map, where values that make a grid larger are largest.
std::vector<Scene> scenes_at_corners(const Scene& scene, const StabilityMap& map) {
  std::vector<Scene> scenes;
  for (const std::string& method : map.options.methods)
    for (const double x : {map.x_values.front(), map.x_values.back()})
      for (const double y : {map.y_values.front(), map.y_values.back()})
        scenes.push_back(cell_scene(scene, map.options, method, x, y));
  return scenes;
}

/// Cells of one method that have one value of the other axis, along the time step where that is an axis, else
/// along x; see line_of.
struct MapLine {
  std::size_t method = 0, first = 0, stride = 1, count = 0;
  bool is_along_step = false;  ///< it has a limit that is measured once its cells are there
  std::size_t left = 0;        ///< cells that are to be run yet
  std::size_t cell(std::size_t k) const { return first + k * stride; }
};

/// Of all methods.
std::vector<MapLine> map_lines(const StabilityMap& map) {
  const std::size_t columns = map.x_values.size(), rows = map.y_values.size();
  const bool x_is_step = map.options.x.path == time_step_path,
             y_is_step = map.options.y.path == time_step_path;
  std::vector<MapLine> lines;
  for (std::size_t method = 0; method < map.options.methods.size(); ++method)
    for (std::size_t k = 0; k < (y_is_step ? columns : rows); ++k)
      lines.push_back({.method = method,
                       .first = y_is_step ? k : k * columns,
                       .stride = y_is_step ? columns : 1,
                       .count = y_is_step ? rows : columns,
                       .is_along_step = x_is_step || y_is_step});
  return lines;
}

/// Goes through the cells, keeps count of the work, and stops when told to.
class MapRunner {
 public:
  MapRunner(const Scene& scene, const StabilityOptions& options)
      : scene_(scene),
        options_(options),
        map_(plan_stability_map(scene, options)),
        lines_(map_lines(map_)),
        team_({.jobs = options.jobs,
               .at_once = runs_that_fit(scenes_at_corners(scene, map_), options.jobs),
               .stop = options.stop,
               .progress = options.progress}) {}

  StabilityMap run();

 private:
  /// A cell to run; none: a line whose cells are all there, and whose limit is not.
  struct Unit {
    std::size_t line = 0;
    std::optional<std::size_t> cell{};
  };

  MethodMap begun(const std::string& method) const;
  bool lay_out();
  void lay_out(const MapLine& line);
  std::vector<Unit> missing_units();
  bool lacks_limit(const MapLine& line) const;
  bool make(const Unit& unit);
  bool run_missing(MapLine& line, std::size_t cell);
  bool measure_limit(const MapLine& line);
  MeasuredLimit limit_between_cells(const MapLine& line) const;
  bool narrow(const std::string& method, MeasuredLimit& limit);
  StabilityCell run_at(const std::string& method, double x, double y);
  std::size_t number_of(const MapLine& line) const { return static_cast<std::size_t>(&line - lines_.data()); }
  bool is_mine(const MapLine& line) const {
    return options_.shard.has(static_cast<std::int64_t>(number_of(line)));
  }
  /// The other axis' value.
  double other_of(const MapLine& line) const {
    const std::size_t columns = map_.x_values.size();
    return x_is_step() ? map_.y_values[line.first / columns] : map_.x_values[line.first % columns];
  }
  bool x_is_step() const { return options_.x.path == time_step_path; }

  // Within team_.alone().
  void tell() const {
    if (options_.partial) options_.partial(map_);
  }
  void report() { team_.report({std::min(1.0, done_ / work_), text_}); }

  const Scene& scene_;
  const StabilityOptions& options_;
  StabilityMap map_;
  std::vector<MapLine> lines_;
  StudyTeam team_;
  double work_ = 0, done_ = 0;
  std::size_t cells_ = 0, begun_ = 0;  ///< of all methods
  std::string text_ = "laying out the map";
};

StabilityCell MapRunner::run_at(const std::string& method, double x, double y) {
  int batches = 0;
  const StopTest stop = [&] {
    if (++batches % batches_between_reports == 0) {
      const auto lock = team_.alone();
      report();
    }
    return team_.is_stopped();
  };
  StabilityCell cell =
      run_cell(cell_scene(scene_, options_, method, x, y), options_.criterion, stop, team_.threads());
  cell.x = x;
  cell.y = y;
  return cell;
}

/// A method's cells, those run that the map which goes on has, with its measured limits.
MethodMap MapRunner::begun(const std::string& name) const {
  const std::vector<double>&x_values = map_.x_values, &y_values = map_.y_values;
  MethodMap map{name, {}, {}};
  if (options_.earlier)
    for (const MethodMap& method : options_.earlier->methods)
      if (method.method == name) map = method;
  for (std::size_t k = map.cells.size(); k < x_values.size() * y_values.size(); ++k)
    map.cells.push_back({.x = x_values[k % x_values.size()], .y = y_values[k / x_values.size()]});
  return map;
}

/// Fills in what is known without running: the limits, and how long each cell will take.
bool MapRunner::lay_out() {
  std::vector<const MapLine*> mine;
  for (const MapLine& line : lines_)
    if (is_mine(line)) mine.push_back(&line);
  return team_.run(mine.size(), [&](std::size_t k) {
    lay_out(*mine[k]);
    return !team_.is_stopped();
  });
}

void MapRunner::lay_out(const MapLine& line) {
  MethodMap& map = map_.methods[line.method];
  for (std::size_t k = 0; k < line.count && !team_.is_stopped(); ++k) {
    StabilityCell& cell = map.cells[line.cell(k)];
    const Scene scene = cell_scene(scene_, options_, map.method, cell.x, cell.y);
    // A time step does not change them.
    cell.limits = k == 0 || !line.is_along_step ? predict_limits(scene) : map.cells[line.cell(k - 1)].limits;
    if (cell.status != CellStatus::not_run) continue;
    cell.time_step = resolved_time_step(scene).value_or(0);
    cell.wanted_steps = cell.time_step > 0 ? wanted_steps(scene, cell.time_step, options_.criterion) : 0;
  }
  for (MeasuredLimit& limit : map.measured)
    if (line.is_along_step && limit.other == other_of(line)) limit.limits = map.cells[line.first].limits;
}

bool MapRunner::lacks_limit(const MapLine& line) const {
  const std::vector<MeasuredLimit>& measured = map_.methods[line.method].measured;
  const auto is_its = [&](const MeasuredLimit& limit) { return limit.other == other_of(line); };
  return line.is_along_step && std::none_of(measured.begin(), measured.end(), is_its);
}

/// Method after method: its cells in their order, then lines that lack nothing but their limits.
std::vector<MapRunner::Unit> MapRunner::missing_units() {
  std::vector<Unit> units;
  for (std::size_t m = 0; m < map_.methods.size(); ++m) {
    const std::vector<StabilityCell>& cells = map_.methods[m].cells;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const auto line = static_cast<std::size_t>(line_of(map_, m, k));
      if (!is_mine(lines_[line]) || cells[k].status != CellStatus::not_run) continue;
      units.push_back({line, k});
      ++lines_[line].left;
      ++cells_;
      work_ += expected_work(cells[k], options_.criterion);
    }
    for (const MapLine& line : lines_)
      if (line.method == m && is_mine(line) && line.left == 0 && lacks_limit(line))
        units.push_back({number_of(line), std::nullopt});
  }
  return units;
}

bool MapRunner::make(const Unit& unit) {
  MapLine& line = lines_[unit.line];
  return unit.cell ? run_missing(line, *unit.cell) : measure_limit(line);
}

/// Whoever runs the last cell of a line measures its limit.
bool MapRunner::run_missing(MapLine& line, std::size_t number) {
  const std::string& method = map_.methods[line.method].method;
  StabilityCell& cell = map_.methods[line.method].cells[number];
  {
    const auto lock = team_.alone();
    text_ = fmt::format("cell {} of {}", ++begun_, cells_);
  }
  StabilityCell result = run_at(method, cell.x, cell.y);
  if (result.status == CellStatus::not_run) return false;
  bool wants_limit = false;
  {
    const auto lock = team_.alone();
    done_ += expected_work(cell, options_.criterion);
    result.limits = cell.limits;
    cell = std::move(result);
    wants_limit = --line.left == 0 && lacks_limit(line);
    tell();
    report();
  }
  return !team_.is_stopped() && (!wants_limit || measure_limit(line));
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

MeasuredLimit MapRunner::limit_between_cells(const MapLine& line) const {
  const std::vector<StabilityCell>& cells = map_.methods[line.method].cells;
  const std::vector<double>& steps = x_is_step() ? map_.x_values : map_.y_values;
  MeasuredLimit limit{.other = other_of(line), .limits = cells[line.first].limits};
  for (std::size_t k = 0; k < line.count; ++k) {
    const StabilityCell& cell = cells[line.cell(k)];
    if (cell.status != CellStatus::run) continue;
    if (!cell.stable())
      limit.shortest_unstable = std::min(limit.shortest_unstable, steps[k]);
    else if (steps[k] < limit.shortest_unstable)
      limit.longest_stable = steps[k];
    else
      limit.stable_beyond = true;
  }
  return limit;
}

/// Precondition: the line's cells are there, and no other thread changes them any more.
bool MapRunner::measure_limit(const MapLine& line) {
  MethodMap& map = map_.methods[line.method];
  MeasuredLimit limit = limit_between_cells(line);
  if (!narrow(map.method, limit)) return false;
  const auto lock = team_.alone();
  map.measured.insert(std::ranges::lower_bound(map.measured, limit.other, {}, &MeasuredLimit::other), limit);
  tell();
  return true;
}

StabilityMap MapRunner::run() {
  for (const std::string& method : options_.methods) map_.methods.push_back(begun(method));
  map_.complete = lay_out();
  const std::vector<Unit> units = missing_units();
  if (!lines_.empty() && lines_.front().is_along_step) work_ *= 1.2;  // for the limits' own runs
  work_ = std::max(work_, 1.0);
  map_.complete = map_.complete && team_.run(units.size(), [&](std::size_t k) { return make(units[k]); });
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
