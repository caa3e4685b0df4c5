#include "study/work_precision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/cut_grid.h"
#include "cloth/mesh_cloth.h"
#include "design/quantile.h"
#include "geometry/split_mix.h"
#include "scene/scene_checks.h"
#include "scene/scene_parameters.h"
#include "simulation/step_batches.h"

namespace cloth {
namespace {

constexpr int max_rungs = 12;
constexpr int promised_rungs = 5;
constexpr double worth_timing = 0.2;        // s, all repeats of a run together
constexpr double limiter_tolerance = 1e-6;  // the default of 1e-4 would stop errors at some 1e-3 m
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// One untimed run: errors at the fixed times, counts, and how it ended.
class UntimedPass {
 public:
  UntimedPass(const WorkPrecision& study, const StepLadder& ladder, const StopTest& stop)
      : study_(study), ladder_(ladder), stop_(stop) {}

  /// nullopt if it was stopped before the end, or `go_on` said false.
  std::optional<WorkPrecisionRun> run(int rung, const std::function<bool()>& go_on) const {
    Simulation simulation(scene_at(study_.scene, ladder_, rung, study_.horizon));
    WorkPrecisionRun result{.rung = rung, .tolerance = ladder_.tolerance(rung), .samples = {}};
    const std::int64_t stride = ladder_.steps(rung) / study_.samples;
    std::vector<ClothState> states;
    StepBatches batches(simulation, stop_);
    const std::int64_t batch =
        study_.scene.deformation ? 1 : stride;  // the limiter's iterations of every step
    for (std::int64_t step = batch; step <= stride * study_.samples && !batches.divergence(); step += batch) {
      if (!batches.run_to(step) && !batches.divergence()) return std::nullopt;
      result.limiter_iterations += simulation.last_limit().direct_iterations;
      if (step % stride != 0) continue;
      if (!go_on()) return std::nullopt;
      if (!batches.divergence()) states.push_back(simulation.state());
    }
    result.count = simulation.count();
    result.steps = ladder_.by_tolerance ? result.count.inner_steps : result.count.steps;
    result.time_step = simulation.time() / static_cast<double>(std::max<std::int64_t>(1, result.steps));
    if (!ladder_.by_tolerance) result.time_step = simulation.time_step();
    result.estimated = estimated_seconds(study_.particles, result.count, result.limiter_iterations);
    judge(simulation, batches.divergence(), states, result);
    return result;
  }

 private:
  void judge(const Simulation& simulation, const std::optional<Divergence>& divergence,
             const std::vector<ClothState>& states, WorkPrecisionRun& result) const {
    if (divergence) {
      result.status = divergence->solver_failed ? RunStatus::solver_failed : RunStatus::diverged;
      result.detail = describe(*divergence);
      result.error = {nan, nan, nan};
      result.energy_error = nan;
      return;
    }
    result.error = difference(states, study_.reference.states);
    result.energy_error = simulation.measure().energy_error();
    if (result.energy_error <= study_.reference.largest_kinetic) return;
    result.status = RunStatus::energy_growth;
    result.detail = fmt::format("the method added {:.3g} J; the cloth never moves with more than {:.3g} J",
                                result.energy_error, study_.reference.largest_kinetic);
  }

  const WorkPrecision& study_;
  const StepLadder& ladder_;
  const StopTest& stop_;
};

int repeats_of(const WorkPrecisionRun& run, int repeats) {
  const double wanted = std::ceil(worth_timing / std::max(run.estimated, 1e-9));
  return static_cast<int>(std::clamp(wanted, 1.0 * repeats, 4.0 * repeats));
}

/// What the run and its repeats cost, in estimated s.
double whole_cost(const WorkPrecisionRun& run, int repeats) {
  return run.estimated * (1 + repeats_of(run, repeats));
}

int reached(const MethodStudy& method) {
  return static_cast<int>(
      std::count_if(method.runs.begin(), method.runs.end(),
                    [](const WorkPrecisionRun& run) { return run.rung >= 0 && run.reached_horizon(); }));
}

/// What `rung` should cost by the rung before it; 0 where nothing is known.
double predicted(const MethodStudy& method, int rung, int repeats) {
  if (rung < 1 || method.runs.empty()) return 0;
  const WorkPrecisionRun& last = method.runs.back();
  if (!last.reached_horizon()) return 0;
  WorkPrecisionRun next{.estimated = (method.ladder.by_tolerance ? 1.6 : 2.0) * last.estimated,
                        .samples = {}};
  return whole_cost(next, repeats);
}

WorkPrecisionRun refused_run(const MethodStudy& method, int rung, double horizon, double cost, double left) {
  WorkPrecisionRun run{.rung = rung, .tolerance = method.ladder.tolerance(rung), .samples = {}};
  run.steps = method.ladder.by_tolerance ? 0 : method.ladder.steps(rung);
  run.time_step = run.steps > 0 ? horizon / static_cast<double>(run.steps) : nan;
  run.error = {nan, nan, nan};
  run.energy_error = nan;
  run.status = RunStatus::refused;
  run.detail = fmt::format("it and its repeats would take some {:.0f} s; {:.0f} s of the budget are left",
                           cost, std::max(0.0, left));
  return run;
}

void tell(WorkPrecision& study, const WorkPrecisionOptions& options) {
  if (!options.partial) return;
  conclude(study);
  options.partial(study);
}

ReferenceSolution make_reference(const WorkPrecision& study, const WorkPrecisionOptions& options);

/// Measures rung by rung, all methods before the next rung, so that what the budget cannot hold are the
/// finest runs.
class Measuring {
 public:
  Measuring(WorkPrecision& study, const WorkPrecisionOptions& options)
      : study_(study), options_(options), active_(study.methods.size(), true) {
    for (std::size_t m = 0; m < active_.size(); ++m)
      active_[m] = !options.shard || options.shard->has(static_cast<std::int64_t>(m));
  }

  /// False if it was stopped.
  bool all() {
    for (int rung = -1; rung < max_rungs; ++rung)
      for (std::size_t m = 0; m < study_.methods.size(); ++m)
        if (active_[m] && !one(m, rung)) return false;
    return true;
  }

 private:
  bool one(std::size_t m, int rung) {
    MethodStudy& method = study_.methods[m];
    if (rung < 0 && method.ladder.beyond_steps == 0) return true;
    if (is_complete(method)) {
      active_[m] = false;
      return true;
    }
    const double left =
        study_.budget - (options_.shard ? reference_cost_ + cost_of(method) : study_.estimated);
    const double cost = predicted(method, rung, study_.repeats);
    const auto sharing =
        options_.shard ? 1.0 : static_cast<double>(std::count(active_.begin(), active_.end(), true));
    if (cost > left / (reached(method) < promised_rungs ? std::min(2.0, sharing) : sharing)) {
      method.runs.push_back(refused_run(method, rung, study_.horizon, cost, left));
      tell(study_, options_);
      active_[m] = false;
      return true;
    }
    const auto run = measured(m, rung);
    if (!run) return false;
    study_.estimated += whole_cost(*run, study_.repeats);
    method.runs.push_back(*run);
    tell(study_, options_);
    return true;
  }

  /// The run, unless it was made before; nullopt if it was stopped.
  std::optional<WorkPrecisionRun> measured(std::size_t m, int rung) {
    const MethodStudy& method = study_.methods[m];
    if (options_.earlier)
      for (const WorkPrecisionRun& run : options_.earlier->methods[m].runs)
        if (run.rung == rung && run.status != RunStatus::refused) return run;
    if (study_.reference.states.empty()) {  // a study that goes on may have lost them
      ReferenceSolution again = make_reference(study_, options_);
      if (!again.failure.empty()) return std::nullopt;
      study_.reference = std::move(again);
    }
    const std::string text = fmt::format("measuring {}", method.ladder.facts.name);
    return UntimedPass(study_, method.ladder, options_.stop).run(rung, [&] {
      return !options_.progress || options_.progress({0.1 + 0.15 * study_.estimated / study_.budget, text});
    });
  }

  /// Enough runs, or errors that no longer say anything.
  bool is_complete(const MethodStudy& method) const {
    if (reached(method) >= options_.steps_per_method) return true;
    if (method.runs.empty() || !method.runs.back().reached_horizon()) return false;
    return reached(method) >= promised_rungs &&
           method.runs.back().error.rms_position < 10 * study_.reference.floor.rms_position;
  }

  double cost_of(const MethodStudy& method) const {
    double sum = 0;
    for (const WorkPrecisionRun& run : method.runs) sum += whole_cost(run, study_.repeats);
    return sum;
  }

  WorkPrecision& study_;
  const WorkPrecisionOptions& options_;
  const double reference_cost_ = study_.estimated;
  std::vector<bool> active_;
};

/// nullopt if it was stopped.
std::optional<double> seconds_of(const WorkPrecision& study, const StepLadder& ladder, int rung,
                                 const StopTest& stop) {
  Simulation simulation(scene_at(study.scene, ladder, rung, study.horizon));
  StepBatches batches(simulation, stop);
  if (!batches.run_to(ladder.steps(rung)) && !batches.divergence()) return std::nullopt;
  return batches.seconds();
}

/// Fisher and Yates with a fixed generator: the same order on every machine.
void shuffle(std::vector<std::pair<MethodStudy*, WorkPrecisionRun*>>& runs, std::uint64_t seed) {
  SplitMix random(seed);
  for (std::size_t k = runs.size(); k > 1; --k) std::swap(runs[k - 1], runs[random.bits() % k]);
}

/// Each run has run once, untimed, before: that was the warm-up. All runs of a repeat in shuffled order.
/// False if stopped.
bool time_all(WorkPrecision& study, const WorkPrecisionOptions& options) {
  double total = 0, spent = 0;
  int most = 0;
  for (const MethodStudy& method : study.methods)
    for (const WorkPrecisionRun& run : method.runs) {
      if (run.status == RunStatus::refused) continue;
      most = std::max(most, repeats_of(run, study.repeats));
      total += run.estimated * repeats_of(run, study.repeats);
    }
  for (int repeat = 1; repeat <= most; ++repeat) {
    std::vector<std::pair<MethodStudy*, WorkPrecisionRun*>> turn;
    for (MethodStudy& method : study.methods)
      for (WorkPrecisionRun& run : method.runs)
        if (run.status != RunStatus::refused && repeat <= repeats_of(run, study.repeats))
          turn.emplace_back(&method, &run);
    shuffle(turn, static_cast<std::uint64_t>(repeat));
    for (std::size_t k = 0; k < turn.size(); ++k) {
      auto& [method, run] = turn[k];
      if (std::any_of(run->samples.begin(), run->samples.end(),
                      [&](const TimedSample& sample) { return sample.repeat == repeat; })) {
        spent += run->estimated;
        continue;  // timed before the study was stopped
      }
      const std::string text =
          fmt::format("timing {}, repeat {} of {}", method->ladder.facts.name, repeat, most);
      if (options.progress && !options.progress({0.25 + 0.75 * spent / std::max(total, 1e-9), text}))
        return false;
      const auto seconds = seconds_of(study, method->ladder, run->rung, options.stop);
      if (!seconds) return false;
      run->samples.push_back({repeat, static_cast<int>(k) + 1, *seconds});
      spent += run->estimated;
      tell(study, options);
    }
  }
  return true;
}

ReferenceSolution make_reference(const WorkPrecision& study, const WorkPrecisionOptions& options) {
  const ReferenceProgress progress = [&](double part) {
    return !options.progress || options.progress({0.1 * part, "solving the reference"});
  };
  if (is_smooth(study.scene))
    return solve_smooth(study.scene, study.horizon, study.samples, progress, options.stop);
  // As fine as a third of the budget allows, at most 64 times the finest step that the ladders plan.
  std::int64_t finest = 0;
  for (const MethodStudy& method : study.methods)
    if (method.ladder.limit && !method.ladder.by_tolerance)
      finest = std::max(finest, method.ladder.steps(promised_rungs - 1));
  const double step_cost = estimated_seconds(study.particles, {.steps = 1, .force_evaluations = 3}, 0);
  const double most = study.budget / 3 / (1.5 * step_cost);
  int ratio = 64;
  while (ratio > 4 && static_cast<double>(finest) * ratio > most) ratio /= 2;
  const std::int64_t unit = 2 * study.samples;
  const std::int64_t steps = std::max<std::int64_t>(finest, unit) * ratio / unit * unit;
  return solve_by_loop(study.scene, study.horizon, study.samples, steps, progress, options.stop);
}

}  // namespace

double estimated_seconds(int particles, const StepCount& count, std::int64_t limiter_iterations) {
  const double n = particles;
  const double per_particle =
      15e-9 * static_cast<double>(count.force_evaluations) + 15e-9 * static_cast<double>(count.steps) +
      300e-9 * static_cast<double>(count.iterations) +
      100e-9 * static_cast<double>(count.linear_iterations + count.velocity_iterations) +
      40e-9 * static_cast<double>(count.limiter_sweeps);
  const double factorisation = 200e-9 * std::pow(n, 1.5);
  return n * per_particle + factorisation * static_cast<double>(count.factorisations + limiter_iterations);
}

TimeSpread spread_of(const std::vector<TimedSample>& samples) {
  if (samples.empty()) return {};
  std::vector<double> seconds;
  for (const TimedSample& sample : samples) seconds.push_back(sample.seconds);
  std::sort(seconds.begin(), seconds.end());
  return {seconds.front(), quantile(seconds, 0.25), quantile(seconds, 0.5), quantile(seconds, 0.75)};
}

void conclude(WorkPrecision& study) {
  for (MethodStudy& method : study.methods) {
    std::vector<OrderPoint> position, velocity;
    for (WorkPrecisionRun& run : method.runs) {
      run.time = spread_of(run.samples);
      if (!run.reached_horizon() || run.rung < 0) continue;
      position.push_back({run.time_step, run.error.rms_position});
      velocity.push_back({run.time_step, run.error.rms_velocity});
    }
    OrderRule rule = order_rule(method.ladder.facts.order);
    rule.excited_frequency = study.reference.excited_frequency;
    rule.floor = study.reference.floor.rms_position;
    rule.scale = study.diagonal;
    method.order = estimate_order(position, rule);
    rule.floor = study.reference.floor.rms_velocity;
    rule.scale = study.diagonal / study.horizon;
    method.velocity_order = estimate_order(velocity, rule);
  }
}

Scene studied_scene(const Scene& scene) {
  Scene studied = scene;
  if (studied.deformation)
    studied.deformation->tolerance = std::min(scene.deformation->tolerance, limiter_tolerance);
  return studied;
}

Scene scene_of(const WorkPrecision& study, const MethodStudy& method, const WorkPrecisionRun& run) {
  return scene_at(study.scene, method.ladder, run.rung, study.horizon);
}

std::optional<std::string> broken_horizon_rule(const Scene& scene, const std::vector<std::string>& methods,
                                               double horizon) {
  Scene studied = scene;
  studied.duration = horizon;
  for (const Parameter& parameter : parameters_of(studied))
    if (parameter.path == "duration")
      if (auto rule = broken_rule(parameter.info, parameter.get(studied))) return rule;
  for (const StepLadder& ladder : make_ladders(scene, methods, horizon).methods)
    if (auto rule = too_many_steps(horizon, horizon / static_cast<double>(ladder.first_steps))) return rule;
  return std::nullopt;
}

WorkPrecision plan_work_precision(const Scene& scene, const WorkPrecisionOptions& options) {
  WorkPrecision study;
  study.scene = studied_scene(scene);
  study.particles = particle_count(scene.cloth);
  study.diagonal = diagonal_of(scene.cloth);
  study.repeats = options.repeats;
  study.steps_per_method = options.steps_per_method;
  study.budget = options.budget;
  const auto& methods = options.methods.empty() ? integrator_names() : options.methods;
  Ladders ladders = make_ladders(scene, methods, options.horizon.value_or(default_horizon(scene)));
  study.horizon = ladders.horizon;
  study.samples = ladders.samples;
  for (StepLadder& ladder : ladders.methods)
    study.methods.push_back({.ladder = std::move(ladder), .runs = {}, .order = {}, .velocity_order = {}});
  return study;
}

namespace {

/// What was made earlier and not come to before a stop.
void keep_earlier(WorkPrecision& study, const WorkPrecision& earlier) {
  for (std::size_t m = 0; m < study.methods.size(); ++m) {
    std::vector<WorkPrecisionRun>& runs = study.methods[m].runs;
    for (const WorkPrecisionRun& run : earlier.methods[m].runs)
      if (run.status != RunStatus::refused && (runs.empty() || run.rung > runs.back().rung))
        runs.push_back(run);
  }
}

}  // namespace

WorkPrecision study_work_precision(const Scene& scene, const WorkPrecisionOptions& options) {
  WorkPrecision study = plan_work_precision(scene, options);
  if (options.earlier) study.parts = options.earlier->parts;
  if (options.earlier && options.earlier->reference.is_known())
    study.reference = options.earlier->reference;
  else
    study.reference = make_reference(study, options);
  if (!study.reference.failure.empty()) {
    study.stopped = study.reference.failure == "stopped";
    return study;
  }
  study.estimated = estimated_seconds(study.particles, {.force_evaluations = study.reference.evaluations}, 0);
  tell(study, options);
  study.stopped = !Measuring(study, options).all() || !time_all(study, options);
  if (study.stopped && options.earlier) keep_earlier(study, *options.earlier);
  tell(study, options);
  conclude(study);
  return study;
}

}  // namespace cloth
