#include "study/stability_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "cloth/grid.h"
#include "cloth/mesh_cloth.h"
#include "integrators/registry.h"
#include "measure/spectrum.h"
#include "measure/stability_limit.h"
#include "scene/scene_checks.h"
#include "simulation/time_step.h"

namespace cloth {
namespace {

constexpr int samples_of_a_run = 400;
constexpr int steps_between_questions = 64;  // whether to go on
constexpr int limit_halvings = 5;            // of the bracket between two cells

/// A number in [-1, 1] that is the same everywhere (splitmix64, Steele et al. 2014).
double next_random(std::uint64_t& state) {
  std::uint64_t bits = (state += 0x9e3779b97f4a7c15u);
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  bits ^= bits >> 31;
  return static_cast<double>(bits >> 11) * 0x1p-52 - 1;
}

/// m, between neighbours at rest.
double shortest_spacing(const ClothSheet& sheet) {
  if (!sheet.is_mesh()) {
    const GridCell grid = cell_of(sheet);
    return std::min(grid.across.norm(), grid.down.norm());
  }
  const SceneMesh& mesh = *sheet.mesh.loaded;
  double shortest = infinity;
  for (const auto& [a, b] : mesh.edges)
    shortest = std::min(shortest, (mesh.surface.vertices[static_cast<std::size_t>(a)] -
                                   mesh.surface.vertices[static_cast<std::size_t>(b)])
                                      .norm());
  return shortest;
}

/// Moves every free particle at random, so that every motion that can grow has something to grow from.
Preparation perturbation(const Scene& cell, const StabilityCriterion& criterion) {
  const double length = criterion.perturbation * shortest_spacing(cell.cloth);
  return [length, seed = criterion.perturbation_seed](ClothSystem& system, ClothState& state) {
    std::uint64_t random = seed;
    for (std::size_t i = 0; i < state.position.size(); ++i) {
      const double x = next_random(random), y = next_random(random), z = next_random(random);
      if (!system.pinned[i]) state.position.add(i, length * Vec3(x, y, z));
    }
  };
}

/// The energy that the scene can give, in J: falling by its own size, the full wind, what it starts with; and
/// a trace of all springs at twice their length, so that a scene in which nothing moves has a scale too.
double energy_scale(const Simulation& run) {
  constexpr double trace = 1e-6;
  const Scene& scene = run.scene();
  const double mass = run.system().total_mass();
  double wind = 0;
  if (scene.air) wind = scene.air->wind.norm() * (1 + (scene.air->gust ? scene.air->gust->amplitude : 0));
  double elastic = 0;
  for (const SpringRun& springs : run.system().springs)
    elastic += 0.5 * springs.stiffness * springs.rest_length * springs.rest_length * springs.count;
  return mass * gravity_of(scene).norm() * run.system().diagonal + 0.5 * mass * wind * wind +
         std::abs(run.checkpoint().ledger.initial) + trace * elastic;
}

/// A mesh stays as it is: no smaller one has the same triangles.
void make_smaller(ClothSheet& cloth) {
  if (cloth.is_mesh()) return;
  const int rows = std::min(cloth.rows, study_grid), columns = std::min(cloth.columns, study_grid);
  const auto scaled = [](int index, int from, int to) {
    return static_cast<int>(std::lround(static_cast<double>(index) * (to - 1) / (from - 1)));
  };
  for (Pin& pin : cloth.pins)
    if (auto* particle = std::get_if<PinnedParticle>(&pin))
      *particle = {scaled(particle->row, cloth.rows, rows), scaled(particle->column, cloth.columns, columns)};
  cloth.mass *= static_cast<double>(rows) * columns / (static_cast<double>(cloth.rows) * cloth.columns);
  cloth.width *= static_cast<double>(columns - 1) / (cloth.columns - 1);
  cloth.height *= static_cast<double>(rows - 1) / (cloth.rows - 1);
  cloth.rows = rows;
  cloth.columns = columns;
}

/// Steps that the criterion asks for.
std::int64_t wanted_steps(const Scene& cell, double time_step, const StabilityCriterion& criterion) {
  const double omega = cell.springs ? largest_frequency(cell.cloth, *cell.springs) : 0;
  double steps = criterion.least_steps;
  if (omega > 0)
    steps = std::max(steps, std::ceil(criterion.periods * 2 * std::numbers::pi / (omega * time_step)));
  return static_cast<std::int64_t>(std::min(steps, 1e15));
}

double seconds_of(const std::optional<double>& limit) {
  return limit.value_or(0);
}

/// Work of a cell, in steps: a run beyond the limit soon ends.
double expected_work(const StabilityCell& cell, const StabilityCriterion& criterion) {
  const double steps = static_cast<double>(std::min<std::int64_t>(cell.wanted_steps, criterion.most_steps));
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
  bool keep_on() {
    if (options_.stop.stop_requested()) return false;
    return ++questions_ % steps_between_questions != 0 || report(done_ / work_);
  }
  void tell() const {
    if (options_.partial) options_.partial(map_);
  }
  bool report(double part) { return !options_.progress || options_.progress(std::min(1.0, part)); }

  bool x_is_step() const { return options_.x.path == time_step_path; }
  bool y_is_step() const { return options_.y.path == time_step_path; }

  const Scene& scene_;
  const StabilityOptions& options_;
  std::vector<double> x_values_, y_values_;
  double work_ = 0, done_ = 0;
  std::int64_t questions_ = 0;
  StabilityMap map_;
};

StabilityCell MapRunner::run_at(const std::string& method, double x, double y) {
  StabilityCell cell =
      run_cell(cell_scene(scene_, options_, method, x, y), options_.criterion, [this] { return keep_on(); });
  cell.x = x;
  cell.y = y;
  return cell;
}

/// Fills in what is known without running: the limits, and how long each cell will take.
bool MapRunner::lay_out(MethodMap& map) {
  for (const double y : y_values_) {
    if (options_.stop.stop_requested()) return false;
    PredictedLimits row_limits;  // a time step does not change them
    for (std::size_t ix = 0; ix < x_values_.size(); ++ix) {
      const Scene scene = cell_scene(scene_, options_, map.method, x_values_[ix], y);
      StabilityCell cell{.x = x_values_[ix], .y = y};
      if (ix == 0 || !x_is_step()) row_limits = predict_limits(scene);
      cell.limits = row_limits;
      cell.time_step = seconds_of(resolved_time_step(scene));
      cell.wanted_steps = cell.time_step > 0 ? wanted_steps(scene, cell.time_step, options_.criterion) : 0;
      work_ += expected_work(cell, options_.criterion);
      map.cells.push_back(std::move(cell));
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
    StabilityCell result = is_known ? before->cells[k] : run_at(map.method, cell.x, cell.y);
    if (result.status == CellStatus::not_run) return false;
    result.limits = limits;
    cell = std::move(result);
    done_ += work;
    tell();
    if (!report(done_ / work_)) return false;
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
  const double stiffness = scene.springs ? scene.springs->structural : 1;
  return {.path = all_stiffnesses_path,
          .low = stiffness / 10,
          .high = stiffness * 10,
          .count = 12,
          .scale = AxisScale::logarithmic};
}

StudyAxis default_time_axis(const Scene& scene, const std::vector<std::string>& methods) {
  constexpr double negligible =
      0.05;  // of the longest limit: such a method would stretch the axis for itself
  const double omega = scene.springs ? largest_frequency(scene.cloth, *scene.springs) : 0;
  const double reference = omega > 0 ? 2 / omega : scene.record.interval;
  double shortest = reference, longest = reference;
  for (const std::string& method : methods) {
    Scene fixed = scene;
    fixed.integrator.method = method;
    fixed.integrator.tolerance = 0;
    const double limit = seconds_of(stable_step(method, fixed));
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

Scene cell_scene(const Scene& scene, const StabilityOptions& options, const std::string& method, double x,
                 double y) {
  Scene cell = scene;
  cell.integrator.method = method;
  if (facts_of(method).settings == MethodSettings::error_control) cell.integrator.tolerance = 0;
  set_number(cell, options.x.path, x, "--x");
  set_number(cell, options.y.path, y, "--y");
  if (!options.full_size && cell.obstacles.empty()) make_smaller(cell.cloth);
  return cell;
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

PredictedLimits predict_limits(const Scene& cell) {
  const std::string& method = cell.integrator.method;
  PredictedLimits limits{.predicted = seconds_of(stable_step(method, cell)),
                         .guaranteed = seconds_of(guaranteed_step(method, cell)),
                         .provot = provot_step(cell),
                         .spectrum = infinity};
  if (!std::isfinite(limits.predicted)) return limits;
  const ClothSystem system = make_cloth(cell.cloth, cell.springs.value_or(SpringMaterial{}));
  const double omega = measure_spectrum(system, system.start).largest_frequency();
  limits.spectrum = seconds_of(stable_step(method, omega, damping_rates(cell)));
  return limits;
}

StabilityCell run_cell(const Scene& scene, const StabilityCriterion& criterion,
                       const std::function<bool()>& keep_on) {
  StabilityCell cell;
  const auto time_step = resolved_time_step(scene);
  if (!time_step) {
    cell.status = CellStatus::refused;
    cell.detail = "no stable step that \"auto\" could take";
    return cell;
  }
  cell.time_step = *time_step;
  cell.wanted_steps = wanted_steps(scene, *time_step, criterion);
  const std::int64_t steps = std::min<std::int64_t>(cell.wanted_steps, criterion.most_steps);
  const std::int64_t stride = std::max<std::int64_t>(1, steps / samples_of_a_run);

  Simulation run(scene, perturbation(scene, criterion));
  const double scale = energy_scale(run);
  std::vector<EnergySample> samples{{0, 0}};
  std::optional<Divergence> divergence;
  while (!divergence && run.state().step < steps) {
    divergence = run.step();
    if (keep_on && !keep_on()) return cell;
    if (run.state().step % stride == 0 && !divergence)
      samples.push_back({run.time(), run.measure().energy_error()});
  }
  const EnergyVerdict verdict = judge_energy(samples, scale, criterion);
  cell.status = CellStatus::run;
  cell.steps = run.state().step;
  cell.run_class = verdict.run_class;
  cell.growth_rate = verdict.growth_rate;
  cell.energy_ratio = verdict.largest_ratio;
  if (divergence) {
    cell.run_class = divergence->solver_failed ? RunClass::solver_failed : RunClass::diverged;
    const double last = std::abs(run.measure().energy_error()) / scale;
    cell.energy_ratio = std::isfinite(last) ? std::max(last, cell.energy_ratio) : infinity;
    cell.detail =
        fmt::format("step {}, particle {}: {}", divergence->step, divergence->particle, divergence->cause);
  } else if (cell.wanted_steps > steps) {
    cell.detail = fmt::format("cut short: {} of {} steps", steps, cell.wanted_steps);
  }
  return cell;
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
