#include "sweep/sweep_points.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "contact/start_check.h"
#include "io/csv.h"
#include "scene/scene_checks.h"
#include "scene/scene_cloth.h"
#include "simulation/time_step.h"
#include "study/study_axis.h"

namespace cloth {
namespace {

/// Where on the axis, from 0 to 1, as a value of one of its paths.
double value_in_range(const SweepAxis& axis, std::size_t path, double unit) {
  const double low = axis.from[path], high = axis.to[path];
  if (unit <= 0) return low;
  if (unit >= 1) return high;
  return axis.scale == AxisScale::logarithmic ? low * std::pow(high / low, unit) : low + unit * (high - low);
}

/// How many values a grid takes of an axis.
std::int64_t grid_count(const SweepAxis& axis) {
  return axis.is_list() ? std::ssize(axis.values) : axis.count;
}

/// Nothing of a grid and a table.
std::optional<Design> sampled_design(SweepDesign design) {
  switch (design) {
    case SweepDesign::latin_hypercube:
      return Design::latin_hypercube;
    case SweepDesign::sobol:
      return Design::sobol;
    case SweepDesign::saltelli:
      return Design::saltelli;
    case SweepDesign::morris:
      return Design::morris;
    default:
      return std::nullopt;
  }
}

}  // namespace

const std::vector<std::string>& sweep_design_names() {
  static const std::vector<std::string> names{"grid",  "points",   "latin-hypercube",
                                              "sobol", "saltelli", "morris"};
  return names;
}

const std::string& name_of(SweepDesign design) {
  return sweep_design_names()[static_cast<std::size_t>(design)];
}

std::vector<std::string> paths_of(const SweepPlan& plan) {
  std::vector<std::string> paths;
  for (const SweepAxis& axis : plan.axes) paths.insert(paths.end(), axis.paths.begin(), axis.paths.end());
  return paths;
}

std::variant<SweptParameter, Problem> SweptParameter::find(const Scene& scene, const std::string& path) {
  SweptParameter found;
  found.path_ = path;
  if (path == all_stiffnesses_path) {
    if (!(leading_stiffness(scene) > 0))
      return Problem{path, "", "needs a scene with structural springs or a material that stretches"};
    found.info_ = {.label = "Stiffness, all in proportion", .unit = "N/m", .minimum = 0};
    return found;
  }
  found.parameter_ = find_parameter(scene, path);
  if (!found.parameter_) return Problem{path, "", "is not a parameter that this scene has"};
  found.info_ = found.parameter_->info;
  if (found.info_.kind == Kind::text) return Problem{path, "", "is a text, which a sweep cannot vary"};
  return found;
}

std::optional<Problem> SweptParameter::set(Scene& scene, const ParameterValue& value) const {
  if (!parameter_) return set_number(scene, path_, std::get<double>(value), "");
  if (const auto rule = broken_rule(info_, value)) return Problem{path_, value_text(info_, value), *rule};
  parameter_->set(scene, value);
  return std::nullopt;
}

std::optional<Problem> broken_sample(const SweepPlan& plan) {
  const auto design = sampled_design(plan.design);
  if (!design) return std::nullopt;
  const std::string rule =
      broken_design_rule(*design, static_cast<std::size_t>(plan.samples), plan.axes.size());
  if (rule.empty()) return std::nullopt;
  return Problem{"samples", std::to_string(plan.samples), rule};
}

UnitPoints unit_points(const SweepPlan& plan) {
  const auto design = sampled_design(plan.design);
  if (!design) return {};
  return unit_design(*design, static_cast<std::size_t>(plan.samples), plan.axes.size(), plan.seed);
}

std::int64_t point_count(const SweepPlan& plan) {
  double count = 1;
  if (const auto design = sampled_design(plan.design))
    count = static_cast<double>(
        rows_of_design(*design, static_cast<std::size_t>(plan.samples), plan.axes.size()));
  else
    for (const SweepAxis& axis : plan.axes) count *= static_cast<double>(grid_count(axis));
  return static_cast<std::int64_t>(std::min(count, 1e15));
}

SweepPoints::SweepPoints(const SweepPlan& plan) : plan_(&plan), count_(point_count(plan)) {
  samples_ = unit_points(plan);
  // A value that an axis sets may bring the parameter of a later one about, as a method its settings.
  Scene scene = plan.scene;
  for (const SweepAxis& axis : plan.axes)
    for (std::size_t k = 0; k < axis.paths.size(); ++k) {
      parameters_.push_back(std::get<SweptParameter>(SweptParameter::find(scene, axis.paths[k])));
      parameters_.back().set(scene, value(axis, k, parameters_.size() - 1, 0));
    }
}

/// `unit`: from 0 to 1 along the axis; values of a list have equal parts of it.
ParameterValue SweepPoints::value(const SweepAxis& axis, std::size_t path, std::size_t of_plan,
                                  double unit) const {
  if (axis.is_list()) {
    const double last = static_cast<double>(axis.values.size() - 1);
    return axis.values[static_cast<std::size_t>(
        std::min(last, std::floor(unit * static_cast<double>(axis.values.size()))))][path];
  }
  const double number = value_in_range(axis, path, unit);
  if (parameters_[of_plan].info().kind == Kind::integer)
    return static_cast<std::int64_t>(std::llround(number));
  return number;
}

std::vector<ParameterValue> SweepPoints::values(std::int64_t point) const {
  std::vector<double> units(plan_->axes.size());
  std::vector<ParameterValue> values(parameters_.size());
  std::int64_t rest = point;
  std::size_t last = parameters_.size();
  for (std::size_t a = plan_->axes.size(); a-- > 0;) {
    const SweepAxis& axis = plan_->axes[a];
    last -= axis.paths.size();
    const std::int64_t count = grid_count(axis);
    for (std::size_t k = 0; k < axis.paths.size(); ++k) {
      if (!samples_.empty())
        values[last + k] = value(axis, k, last + k, samples_[static_cast<std::size_t>(point)][a]);
      else if (axis.is_list())
        values[last + k] = axis.values[static_cast<std::size_t>(rest % count)][k];
      else
        values[last + k] =
            value(axis, k, last + k,
                  count > 1 ? static_cast<double>(rest % count) / static_cast<double>(count - 1) : 0);
    }
    if (samples_.empty()) rest /= count;
  }
  return values;
}

SceneReading SweepPoints::scene(std::int64_t point) const {
  SceneReading reading{plan_->scene, {}};
  const std::vector<ParameterValue> all = values(point);
  for (std::size_t k = 0; k < all.size(); ++k)
    if (auto problem = parameters_[k].set(*reading.scene, all[k]))
      reading.problems.push_back(std::move(*problem));
  if (reading.problems.empty()) reading.problems = find_problems(*reading.scene);
  if (reading.problems.empty()) reading.problems = find_start_problems(*reading.scene);
  return reading;
}

std::optional<Problem> unknown_output(const SweepPlan& plan) {
  Scene scene = plan.scene;
  if (!resolved_time_step(scene)) scene.integrator.time_step = 1e-6;  // it is not to be run
  const Simulation simulation(scene);
  const std::vector<std::string> known = output_sources(simulation);
  for (std::size_t k = 0; k < plan.outputs.size(); ++k)
    if (const std::string& of = plan.outputs[k].of; std::find(known.begin(), known.end(), of) == known.end())
      return Problem{fmt::format("outputs.{}.of", k), fmt::format("\"{}\"", of),
                     fmt::format("must be a column that this scene records or a shape measure: {}",
                                 fmt::join(known, ", "))};
  return std::nullopt;
}

std::string csv_value(const ParameterValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return csv_number(*number);
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return std::to_string(*whole);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* words = std::get_if<Words>(&value)) return fmt::format("{}", fmt::join(*words, " "));
  const Vec3& vector = std::get<Vec3>(value);
  return csv_number(vector.x()) + " " + csv_number(vector.y()) + " " + csv_number(vector.z());
}

}  // namespace cloth
