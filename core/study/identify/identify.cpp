#include "study/identify/identify.h"

#include <fmt/format.h>

#include <cassert>
#include <chrono>
#include <cmath>
#include <set>

#include "io/fnv_hash.h"
#include "scene/scene_checks.h"
#include "scene/scene_json.h"
#include "simulation/in_threads.h"
#include "simulation/recorder.h"
#include "study/refined_scene.h"
#include "study/study_axis.h"

namespace cloth {
namespace {

/// Rows of the columns that are wanted, by their names.
struct RunSeries {
  std::vector<double> time;
  std::map<std::string, std::vector<double>> columns;
};

std::set<std::string> wanted_columns(const IdentifyPlan& plan) {
  std::set<std::string> columns;
  for (const ColumnTarget& target : plan.targets) columns.insert(target.column);
  for (const FittedCurve& curve : plan.curves) columns.insert(curve.column);
  return columns;
}

/// nullopt where there is no run, or it did not come to its end.
std::optional<RunSeries> run_of(const Scene& scene, const std::set<std::string>& wanted,
                                const StopTest& stop) {
  if (!find_problems(scene).empty() || !refusal_to_run(scene).empty()) return std::nullopt;
  RunSeries series;
  RunOptions options;
  options.row = [&](const Simulation& simulation, const Measurement& row) {
    series.time.push_back(row.time);
    for (const std::string& column : wanted)
      series.columns[column].push_back(value_of_output(column, simulation, row));
  };
  options.progress = [&](double) { return !is_to_stop(stop); };
  if (run_scene(scene, options).summary.status != Status::finished) return std::nullopt;
  return series;
}

double reduced(const RunSeries& series, const ColumnTarget& target) {
  OutputReducer reducer({.of = target.column, .reduce = target.over});
  const std::vector<double>& values = series.columns.at(target.column);
  for (std::size_t k = 0; k < values.size(); ++k) reducer.add(series.time[k], values[k]);
  return reducer.result();
}

/// At a time, on the straight line between the rows around it; outside of them the first or the last value.
double value_at(const std::vector<double>& times, const std::vector<double>& values, double at) {
  const auto after = std::lower_bound(times.begin(), times.end(), at);
  if (after == times.begin()) return values.front();
  if (after == times.end()) return values.back();
  const auto k = static_cast<std::size_t>(after - times.begin());
  return values[k - 1] + (at - times[k - 1]) / (times[k] - times[k - 1]) * (values[k] - values[k - 1]);
}

/// One number for each target of the fit: the targets, then the points of the curves.
std::vector<double> outputs_of(const IdentifyPlan& plan, const std::vector<double>& values) {
  const auto series = run_of(scene_with(plan, values), wanted_columns(plan), plan.stop);
  std::vector<double> outputs;
  if (!series) return outputs;
  for (const ColumnTarget& target : plan.targets) outputs.push_back(reduced(*series, target));
  for (const FittedCurve& curve : plan.curves)
    for (const double time : curve.times)
      outputs.push_back(value_at(series->time, series->columns.at(curve.column), time));
  return outputs;
}

/// The same, of the runs that are kept where it was made before.
std::vector<double> kept_outputs(const IdentifyPlan& plan, const std::vector<double>& values) {
  if (!plan.runs) return outputs_of(plan, values);
  if (auto found = plan.runs->find(values)) return *found;
  std::vector<double> outputs = outputs_of(plan, values);
  const bool was_cut_short = outputs.empty() && is_to_stop(plan.stop);
  if (!was_cut_short) plan.runs->add(values, outputs);
  return outputs;
}

FitParameter fit_parameter(const VariedParameter& varied) {
  return {varied.path, varied.unit, varied.low, varied.high,
          varied.low > 0 ? FitScale::logarithmic : FitScale::linear};
}

/// One hundredth: what a sigma is taken for where none is given.
constexpr double assumed_error = 0.01;

double largest_magnitude(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest > 0 ? largest : 1;
}

std::vector<FitTarget> fit_targets(const IdentifyPlan& plan) {
  std::vector<FitTarget> targets;
  for (const ColumnTarget& target : plan.targets)
    targets.push_back({target.name(), unit_of_output(target.column), target.measured,
                       target.sigma.value_or(assumed_error * largest_magnitude({target.measured})),
                       target.held_out});
  for (const FittedCurve& curve : plan.curves)
    for (std::size_t k = 0; k < curve.times.size(); ++k)
      targets.push_back(
          {curve.column, unit_of_output(curve.column), curve.values[k],
           curve.sigmas.empty() ? assumed_error * largest_magnitude(curve.values) : curve.sigmas[k], false});
  return targets;
}

bool has_sigmas(const IdentifyPlan& plan) {
  return std::all_of(plan.targets.begin(), plan.targets.end(),
                     [](const auto& t) { return t.sigma.has_value(); }) &&
         std::all_of(plan.curves.begin(), plan.curves.end(), [](const auto& c) { return !c.sigmas.empty(); });
}

bool has_no_sigma(const IdentifyPlan& plan) {
  return std::none_of(plan.targets.begin(), plan.targets.end(),
                      [](const auto& t) { return t.sigma.has_value(); }) &&
         std::all_of(plan.curves.begin(), plan.curves.end(), [](const auto& c) { return c.sigmas.empty(); });
}

/// Each measured column, with the targets that are its points.
std::vector<FitCurve> curves_of(const IdentifyPlan& plan) {
  std::vector<FitCurve> curves;
  std::size_t next = plan.targets.size();
  for (const FittedCurve& curve : plan.curves) {
    FitCurve points{.name = curve.column};
    points.x = {.label = "time", .unit = "s"};
    points.y = {.label = curve.column, .unit = unit_of_output(curve.column)};
    points.at = curve.times;
    for (std::size_t k = 0; k < curve.times.size(); ++k) points.targets.push_back(next++);
    curves.push_back(std::move(points));
  }
  return curves;
}

}  // namespace

Scene scene_with(const IdentifyPlan& plan, const std::vector<double>& values) {
  Scene scene = plan.scene;
  for (std::size_t j = 0; j < plan.varied.size(); ++j)
    set_number(scene, plan.varied[j].path, values[j], "--vary");  // the bounds were tried
  return scene;
}

std::string model_hash(const IdentifyPlan& plan) {
  FnvHash hash;
  hash.add(scene_hash(plan.scene));
  for (const VariedParameter& varied : plan.varied) hash.add(varied.path + "\n");
  for (const ColumnTarget& target : plan.targets) hash.add(target.name() + "\n");
  for (const FittedCurve& curve : plan.curves) {
    hash.add(curve.column + "\n");
    hash.add(curve.times);
  }
  return hash.text();
}

std::vector<Problem> find_problems(const IdentifyPlan& plan) {
  std::vector<Problem> problems;
  const auto add = [&](const char* place, const std::string& value, const std::string& rule) {
    problems.push_back({.path = "", .value = value, .rule = rule, .place = place});
  };
  if (plan.varied.empty()) add("--vary", "", "name at least one parameter");
  if (plan.curves.empty() && std::all_of(plan.targets.begin(), plan.targets.end(),
                                         [](const ColumnTarget& target) { return target.held_out; }))
    add("--target", "", "name at least one measured value, or a table with --measured");
  if (!has_sigmas(plan) && !has_no_sigma(plan))
    add("--target", "", "give every measured value a standard deviation, or none of them");
  std::set<std::string> paths, targets;
  for (const VariedParameter& varied : plan.varied) {
    if (!paths.insert(varied.path).second) add("--vary", varied.path, "is there twice");
    if (varied.is_whole && plan.options.method == FitMethod::levenberg_marquardt)
      add("--vary", varied.path,
          "is a whole number, so that outputs jump: --method derivative-free finds it");
  }
  for (const ColumnTarget& target : plan.targets)
    if (!targets.insert(target.name()).second) add("--target", target.name(), "is there twice");
  for (const bool high : {false, true}) {
    std::vector<double> ends;
    for (const VariedParameter& varied : plan.varied) ends.push_back(high ? varied.high : varied.low);
    for (const Problem& problem : find_problems(scene_with(plan, ends)))
      add("--vary", "", std::string("at the ") + (high ? "upper" : "lower") + " ends: " + problem.text());
    if (!problems.empty()) break;
  }
  return problems;
}

FitAccount identify(const IdentifyPlan& plan) {
  assert(find_problems(plan).empty());
  FitAccount account{.title = plan.scene.title, .command = plan.command, .options = plan.options};
  for (const VariedParameter& varied : plan.varied) {
    account.problem.parameters.push_back(fit_parameter(varied));
    account.options.start.push_back(varied.start);
  }
  account.problem.targets = fit_targets(plan);
  account.problem.sigmas_known = has_sigmas(plan);
  account.curves = curves_of(plan);
  FitProblem problem = account.problem;
  problem.evaluate = [&](const std::vector<std::vector<double>>& points) {
    std::vector<std::vector<double>> outputs(points.size());
    in_threads(points.size(), plan.jobs, [&](std::size_t i) { outputs[i] = kept_outputs(plan, points[i]); });
    return outputs;
  };
  const auto start = std::chrono::steady_clock::now();
  FitOptions options = account.options;
  options.progress = [&](const FitProgress& progress) {
    if (plan.runs && plan.runs->error()) return false;
    return !is_to_stop(plan.stop) && (!account.options.progress || account.options.progress(progress));
  };
  account.result = fit(problem, options);
  account.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  account.options.progress = {};
  const FitStatus status = account.result.status;
  if (!plan.scene.integrator.time_step &&
      (status == FitStatus::stalled || status == FitStatus::max_iterations))
    account.result.cautions.emplace_back(
        "The time step is auto: where it is another for another value, outputs jump a little. A step of its "
        "own "
        "(integrator.time_step) keeps it.");
  return account;
}

}  // namespace cloth
