#include "study/stability_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "integrators/registry.h"
#include "report/svg.h"
#include "scene/scene_json.h"

namespace cloth {
namespace {

constexpr int points_of_a_curve = 4;  // between two rows of cells

/// Those of a run in the order of RunClass, then those of a cell without one.
constexpr const char* cell_statuses[] = {"accurate",      "stable-inaccurate", "energy-growth", "diverged",
                                         "solver-failed", "refused",           "not-run"};
constexpr std::size_t refused_status = 5;

std::size_t status_index(const StabilityCell& cell) {
  if (cell.status == CellStatus::run) return static_cast<std::size_t>(cell.run_class);
  return refused_status + (cell.status == CellStatus::refused ? 0 : 1);
}

std::size_t cell_count(const StabilityMap& map) {
  return map.x_values.size() * map.y_values.size();
}

/// A value of each row or column of cells, as a function of the values between and half a cell beyond them.
std::vector<double> finer_values(const std::vector<double>& values, AxisScale scale) {
  const bool logarithmic = scale == AxisScale::logarithmic;
  const auto place = [&](double value) { return logarithmic ? std::log(value) : value; };
  const double low = place(values.front()), high = place(values.back());
  const double spacing = (high - low) / static_cast<double>(values.size() - 1);
  const int count = static_cast<int>(values.size()) * points_of_a_curve;
  std::vector<double> finer;
  for (int k = 0; k <= count; ++k) {
    const double value = low - 0.5 * spacing + (high - low + spacing) * k / count;
    finer.push_back(logarithmic ? std::exp(value) : value);
  }
  return finer;
}

double interpolated(const std::vector<double>& at, const std::vector<double>& values, double where,
                    AxisScale scale) {
  const auto place = [&](double value) { return scale == AxisScale::logarithmic ? std::log(value) : value; };
  std::size_t k = 1;
  while (k + 1 < at.size() && where > at[k]) ++k;
  const double t = (place(where) - place(at[k - 1])) / (place(at[k]) - place(at[k - 1]));
  return std::exp(std::log(values[k - 1]) + t * std::log(values[k] / values[k - 1]));
}

using LimitOf = double PredictedLimits::*;

/// Where the time step equals the limit.
std::vector<std::pair<double, double>> limit_curve(const StabilityMap& map, const MethodMap& method,
                                                   LimitOf limit) {
  std::vector<std::pair<double, double>> curve;
  if (method.cells.size() != cell_count(map)) return curve;
  const std::size_t columns = map.x_values.size(), rows = map.y_values.size();
  const bool x_is_step = map.options.x.path == time_step_path,
             y_is_step = map.options.y.path == time_step_path;
  if (x_is_step || y_is_step) {
    const StudyAxis& other = x_is_step ? map.options.y : map.options.x;
    const std::vector<double>& others = x_is_step ? map.y_values : map.x_values;
    std::vector<double> limits;
    for (std::size_t k = 0; k < others.size(); ++k)
      limits.push_back(method.cells[x_is_step ? k * columns : k].limits.*limit);
    if (!std::all_of(limits.begin(), limits.end(), finite_positive)) return curve;
    for (const double value : finer_values(others, other.scale)) {
      const double step = interpolated(others, limits, value, other.scale);
      curve.emplace_back(x_is_step ? std::pair(step, value) : std::pair(value, step));
    }
    return curve;
  }
  // Neither: in each row the first place along x where step / limit passes 1.
  for (std::size_t iy = 0; iy < rows; ++iy)
    for (std::size_t ix = 0; ix + 1 < columns; ++ix) {
      const StabilityCell& left = method.cells[iy * columns + ix];
      const StabilityCell& right = method.cells[iy * columns + ix + 1];
      if (!finite_positive(left.limits.*limit) || !finite_positive(right.limits.*limit)) continue;
      if (!(left.time_step > 0) || !(right.time_step > 0)) continue;
      const double a = std::log(left.time_step / (left.limits.*limit));
      const double b = std::log(right.time_step / (right.limits.*limit));
      if ((a <= 0) == (b <= 0)) continue;
      const double t = a / (a - b);
      const bool logarithmic = map.options.x.scale == AxisScale::logarithmic;
      curve.emplace_back(
          logarithmic ? left.x * std::pow(right.x / left.x, t) : left.x + t * (right.x - left.x), left.y);
      break;
    }
  return curve;
}

HeatCell heat_cell(const StabilityCell& cell) {
  if (cell.status != CellStatus::run) return {.class_index = -1, .note = cell.detail};
  std::string note =
      fmt::format("energy error {} of the scale, {} steps", short_number(cell.energy_ratio, 2), cell.steps);
  if (!cell.detail.empty()) note += "; " + cell.detail;
  return {.class_index = static_cast<int>(cell.run_class), .note = note};
}

const MeasuredLimit* worst_limit(const MethodMap& method) {
  const MeasuredLimit* worst = nullptr;
  double largest = -1;
  for (const MeasuredLimit& limit : method.measured) {
    if (!limit.bracketed() || !finite_positive(limit.limits.predicted)) continue;
    const double deviation = std::abs(std::log(limit.middle() / limit.limits.predicted));
    if (deviation > largest) largest = deviation, worst = &limit;
  }
  return worst;
}

std::ptrdiff_t cells_cut_short(const StabilityMap& map) {
  std::ptrdiff_t count = 0;
  for (const MethodMap& method : map.methods)
    count += std::count_if(method.cells.begin(), method.cells.end(), [&](const StabilityCell& cell) {
      return cell.status == CellStatus::run && cell.steps >= map.options.criterion.max_steps &&
             cell.wanted_steps > cell.steps;
    });
  return count;
}

/// A sentence where a method's predicted limits do not lie on the map; empty where they do.
std::string limits_outside(const StabilityMap& map, const MethodMap& method) {
  const bool x_is_step = map.options.x.path == time_step_path;
  if ((!x_is_step && map.options.y.path != time_step_path) || method.cells.empty()) return {};
  const std::vector<double>& steps = x_is_step ? map.x_values : map.y_values;
  double shortest = infinity, longest = 0;
  for (const StabilityCell& cell : method.cells) {
    if (cell.status == CellStatus::not_run && cell.time_step == 0) continue;  // not laid out
    shortest = std::min(shortest, cell.limits.predicted);
    longest = std::max(longest, cell.limits.predicted);
  }
  const std::string& title = facts_of(method.method).title;
  if (shortest > longest) return {};
  if (std::isinf(shortest)) return title + ": for small motions every step is predicted to be stable.";
  if (longest <= 0) return title + ": no step is predicted to be stable.";
  if (longest >= steps.front() && shortest <= steps.back()) return {};
  return fmt::format("{}: the predicted limit is outside of this map, {} to {} s.", title,
                     short_number(shortest, 2), short_number(longest, 2));
}

}  // namespace

std::size_t count_of(const MethodMap& method, RunClass run_class) {
  return static_cast<std::size_t>(
      std::count_if(method.cells.begin(), method.cells.end(), [&](const StabilityCell& cell) {
        return cell.status == CellStatus::run && cell.run_class == run_class;
      }));
}

std::string axis_text(const StudyAxis& axis) {
  return fmt::format("{}={}:{}:{}:{}", axis.path, short_number(axis.low, 6), short_number(axis.high, 6),
                     axis.count, axis.scale == AxisScale::logarithmic ? "log" : "lin");
}

std::string status_of(const StabilityCell& cell) {
  return cell_statuses[status_index(cell)];
}

void visit_fields(CsvFields& fields, StabilityCell& cell, const std::string& method) {
  const bool run = cell.status == CellStatus::run;
  std::size_t status = status_index(cell);
  fields.derived("method", method);
  fields.number("x", cell.x);
  fields.number("y", cell.y);
  fields.choice("status", status, cell_statuses);
  fields.number("energy_ratio", cell.energy_ratio, run, 0.0);
  fields.number("predicted_limit_s", cell.limits.predicted);
  fields.number("guaranteed_limit_s", cell.limits.guaranteed);
  fields.number("provot_s", cell.limits.provot);
  fields.number("spectrum_limit_s", cell.limits.spectrum);
  fields.number("time_step_s", cell.time_step);
  fields.number("growth_rate_per_s", cell.growth_rate, run, 0.0);
  fields.whole("steps", cell.steps);
  fields.text("detail", cell.detail);
  fields.whole("wanted_steps", cell.wanted_steps);
  cell.status = status < refused_status    ? CellStatus::run
                : status == refused_status ? CellStatus::refused
                                           : CellStatus::not_run;
  if (status < refused_status) cell.run_class = static_cast<RunClass>(status);
}

CsvTable table_of(const StabilityMap& map) {
  CsvTable table{written(StabilityCell{}, std::string()).names, {}};
  for (const MethodMap& method : map.methods)
    for (const StabilityCell& cell : method.cells) table.rows.push_back(written(cell, method.method).texts);
  return table;
}

std::vector<std::string> criterion_text(const StabilityMap& map) {
  const StabilityCriterion& c = map.options.criterion;
  std::vector<std::string> text;
  text.push_back(fmt::format(
      "Each cell is a run of {:g} periods of the fastest motion, at least {} steps and at most {}, from the "
      "scene's start with every free particle moved at random by up to {:g} of a cell's length (seed {}).",
      c.periods, c.least_steps, c.max_steps, c.perturbation, c.perturbation_seed));
  text.push_back(fmt::format(
      "Diverged: not finite, or ten times the kinetic energy that the scene could give. Energy growth: the "
      "method created more than {:g} of the energy scale and what it created still grew steadily, {:g} times "
      "or more over the second half of the run; or it created the whole scale. Stable but inaccurate: "
      "neither, "
      "but the energy error passed {:g} % of the scale. Solver failed: the equations of a step were not "
      "solved. The energy error is the change of the total energy less all works and losses.",
      c.growth, c.growth_factor, 100 * c.accuracy));
  text.push_back(
      "Energy scale: weight times diagonal, plus the cloth's kinetic energy at full wind, plus what it "
      "starts with, plus a millionth of all springs at twice their length.");
  const ClothSheet& cloth = map.scene.cloth;
  if (map.rows != cloth.rows || map.columns != cloth.columns)
    text.push_back(
        fmt::format("Run on {} x {} particles instead of {} x {}, with the same cells, particle mass "
                    "and stiffness: the largest frequency is the same.",
                    map.rows, map.columns, cloth.rows, cloth.columns));
  if (map.scene.deformation || !map.scene.obstacles.empty())
    text.push_back(
        "The scene has deformation limiting or contact. Both take part in the runs and can hold an "
        "unstable motion down; the predicted limits know neither.");
  if (map.options.x.path != time_step_path && map.options.y.path != time_step_path)
    text.push_back("Neither axis is the time step: a curve is where the step of the run equals the limit.");
  if (const auto cut = cells_cut_short(map); cut > 0)
    text.push_back(fmt::format("{} cells were cut short at {} steps.", cut, c.max_steps));
  for (const MethodMap& method : map.methods)
    if (std::string outside = limits_outside(map, method); !outside.empty())
      text.push_back(std::move(outside));
  if (!map.complete) text.push_back("Interrupted: empty cells were not run.");
  return text;
}

HeatMap study_plot(const StabilityMap& map) {
  HeatMap heat;
  heat.title = "Stability: " + map.scene.title;
  heat.subtitle = fmt::format("{} x {} particles, {:g} periods of the fastest motion", map.rows, map.columns,
                              map.options.criterion.periods);
  heat.caption = criterion_text(map);
  heat.x = plot_axis(map.options.x, map.scene);
  heat.y = plot_axis(map.options.y, map.scene);
  heat.x_values = map.x_values;
  heat.y_values = map.y_values;
  int run = 0;  // counted over all methods
  heat.columns = map.options.methods.size() == 4 || map.options.methods.size() < 3 ? 2 : 3;
  for (const MethodMap& method : map.methods) {
    HeatPanel panel{.title = facts_of(method.method).title, .cells = {}, .curves = {}};
    for (const StabilityCell& cell : method.cells) {
      panel.cells.push_back(heat_cell(cell));
      panel.cells.back().tag = cell.status == CellStatus::run ? run : -1;
      ++run;
    }
    panel.cells.resize(cell_count(map), HeatCell{.class_index = -1});
    const auto add = [&](const char* label, Dash dash, LimitOf limit) {
      auto points = limit_curve(map, method, limit);
      if (!points.empty()) panel.curves.push_back({label, dash, page_colours().ink, std::move(points)});
    };
    add("predicted limit", Dash::solid, &PredictedLimits::predicted);
    add("guaranteed for any shape", Dash::dashed, &PredictedLimits::guaranteed);
    add("Provot's criterion", Dash::dotted, &PredictedLimits::provot);
    heat.panels.push_back(std::move(panel));
  }
  return heat;
}

double largest_deviation(const MethodMap& method) {
  const MeasuredLimit* worst = worst_limit(method);
  return worst ? worst->middle() / worst->limits.predicted : 0;
}

std::string study_text(const StabilityMap& map) {
  std::string text = fmt::format("{:<22} {:>9} {:>11} {:>9} {:>9} {:>7}   {}\n", "method", "accurate",
                                 "inaccurate", "growth", "diverged", "failed", "measured / predicted limit");
  for (const MethodMap& method : map.methods) {
    text += fmt::format("{:<22}", method.method);
    constexpr int widths[] = {9, 11, 9, 9, 7};
    for (int k = 0; k < 5; ++k)
      text += fmt::format(" {:>{}}", count_of(method, static_cast<RunClass>(k)), widths[k]);
    const double worst = largest_deviation(method);
    text += worst > 0 ? fmt::format("   {:.3f} at worst\n", worst) : "\n";
  }
  return text;
}

std::string study_json(const StabilityMap& map) {
  using json = nlohmann::ordered_json;
  const auto limit_json = [](double limit) { return std::isinf(limit) ? json("infinity") : json(limit); };
  json root{{"scene_hash", scene_hash(map.scene)},
            {"complete", map.complete},
            {"rows", map.rows},
            {"columns", map.columns},
            {"x", axis_text(map.options.x)},
            {"y", axis_text(map.options.y)},
            {"criterion", criterion_text(map)},
            {"methods", json::array()}};
  for (const MethodMap& method : map.methods) {
    json entry{{"name", method.method}, {"cells", json::object()}, {"limits", json::array()}};
    for (const StabilityCell& cell : method.cells) {
      json& count = entry["cells"][status_of(cell)];
      count = count.is_null() ? 1 : count.get<int>() + 1;
    }
    for (const MeasuredLimit& limit : method.measured)
      entry["limits"].push_back({{"at", limit.other},
                                 {"measured_s", limit.bracketed() ? json(limit.middle()) : json(nullptr)},
                                 {"predicted_s", limit_json(limit.limits.predicted)},
                                 {"guaranteed_s", limit_json(limit.limits.guaranteed)},
                                 {"spectrum_s", limit_json(limit.limits.spectrum)},
                                 {"provot_s", limit_json(limit.limits.provot)}});
    root["methods"].push_back(std::move(entry));
  }
  return root.dump(2) + "\n";
}

}  // namespace cloth
