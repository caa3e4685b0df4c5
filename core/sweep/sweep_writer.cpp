#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/fnv_hash.h"
#include "io/json_syntax.h"
#include "sweep/sweep_plan.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

json json_of_axis(const SweepAxis& axis) {
  json entry = json::object();
  if (axis.paths.size() == 1)
    entry["path"] = axis.paths.front();
  else
    entry["paths"] = axis.paths;
  if (axis.is_list()) {
    json rows = json::array();
    for (const auto& values : axis.values) {
      json row = json::array();
      for (const ParameterValue& value : values) row.push_back(json::parse(value_json(value)));
      rows.push_back(axis.paths.size() == 1 ? row.front() : row);
    }
    entry["values"] = rows;
    return entry;
  }
  const auto ends = [](const std::vector<double>& all) { return all.size() == 1 ? json(all[0]) : json(all); };
  entry["from"] = ends(axis.from);
  entry["to"] = ends(axis.to);
  if (axis.count > 0) entry["count"] = axis.count;
  if (axis.scale == AxisScale::logarithmic) entry["scale"] = "log";
  return entry;
}

json json_of_output(const RunOutput& output) {
  json entry{{"name", output.name}, {"of", output.of}, {"reduce", name_of(output.reduce)}};
  if (std::isfinite(output.to)) entry["window"] = {output.from, output.to};
  if (has_bound(output.reduce))
    entry["bound"] = output.bound;
  if (output.reduce == Reduction::rms)
    entry["measured"] = {
        {"file", output.measured.file}, {"times", output.measured.times}, {"values", output.measured.values}};
  return entry;
}

json json_of_limits(const SweepLimits& limits) {
  json entry = json::object();
  if (limits.steps > 0) entry["steps"] = limits.steps;
  if (limits.wall > 0) entry["wall_s"] = limits.wall;
  return entry;
}

/// A list with an entry on each line.
std::string lines_of(const json& list) {
  std::string text = "[";
  for (const json& entry : list) {
    text += text.size() > 1 ? ",\n    " : "\n    ";
    text += entry.dump(-1, ' ', false, json::error_handler_t::replace);
  }
  return text + "\n  ]";
}

}  // namespace

std::string write_sweep(const SweepPlan& plan) {
  json axes = json::array(), outputs = json::array();
  for (const SweepAxis& axis : plan.axes) axes.push_back(json_of_axis(axis));
  for (const RunOutput& output : plan.outputs) outputs.push_back(json_of_output(output));
  std::string text = fmt::format("{{\n  \"format\": \"{}\",\n", sweep_format);
  text += fmt::format("  \"title\": {},\n",
                      json(plan.title).dump(-1, ' ', false, json::error_handler_t::replace));
  text += fmt::format("  \"scene\": {},\n", indented_json(write_scene(plan.scene)));
  text += fmt::format("  \"vary\": {},\n  \"design\": \"{}\",\n", lines_of(axes), name_of(plan.design));
  if (plan.samples > 0) text += fmt::format("  \"samples\": {},\n", plan.samples);
  text += fmt::format("  \"seed\": {},\n  \"outputs\": {}", plan.seed, lines_of(outputs));
  if (const json limits = json_of_limits(plan.limits); !limits.empty())
    text += ",\n  \"limits\": " + limits.dump();
  return text + "\n}\n";
}

std::string plan_hash(const SweepPlan& plan) {
  FnvHash hash;
  hash.add(write_sweep(plan));
  hash.add(scene_hash(plan.scene));
  return hash.text();
}

}  // namespace cloth
