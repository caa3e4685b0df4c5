#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "contact/start_check.h"
#include "io/csv.h"
#include "io/json_entry.h"
#include "io/json_reader.h"
#include "io/json_syntax.h"
#include "scene/builtin_scenes.h"
#include "sweep/sweep_output_reader.h"
#include "sweep/sweep_points.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

const std::vector<std::string> plan_keys{"format", "title",   "scene", "set",     "vary",  "design",
                                         "points", "samples", "seed",  "outputs", "limits"};
const std::vector<std::string> axis_keys{"path", "paths", "values", "from", "to", "count", "scale"};
constexpr int most_values = 1'000'000;

/// A value of the file as the parameter's kind has it; nothing, and the rule, where it is none.
std::optional<ParameterValue> typed_value(const ParameterInfo& info, const json& value, std::string& rule) {
  if (value.is_string() && info.auto_allowed && value == "auto") return value.get<std::string>();
  switch (info.kind) {
    case Kind::number:
      if (value.is_number()) return value.get<double>();
      rule = "must be a number";
      return std::nullopt;
    case Kind::integer:
      if (value.is_number() && std::floor(value.get<double>()) == value.get<double>() &&
          std::abs(value.get<double>()) <= largest_whole)
        return static_cast<std::int64_t>(value.get<double>());
      rule = "must be a whole number";
      return std::nullopt;
    case Kind::vector:
      if (value.is_array() && value.size() == 3 &&
          std::all_of(value.begin(), value.end(), [](const json& one) { return one.is_number(); }))
        return Vec3(value[0].get<double>(), value[1].get<double>(), value[2].get<double>());
      rule = "must be a list of three numbers";
      return std::nullopt;
    case Kind::words:
      if (value.is_array() &&
          std::all_of(value.begin(), value.end(), [](const json& one) { return one.is_string(); }))
        return value.get<Words>();
      rule = "must be a list of words";
      return std::nullopt;
    default:
      if (value.is_string()) return value.get<std::string>();
      rule = "must be a text in quotes";
      return std::nullopt;
  }
}

/// A field of a table as a value of the file would be: a number where it can be one.
json json_of_field(const std::string& field) {
  double number = 0;
  if (read_table_number(field, number)) return number;
  return field;
}

class SweepReader : public JsonReader<json> {
 public:
  SweepReader(std::string place, fs::path folder) : place_(std::move(place)), folder_(std::move(folder)) {}

  SweepPlan read(const json& root) {
    SweepPlan plan;
    if (!object(root, "")) return plan;
    known_keys(root, "", plan_keys);
    format(root, sweep_format);
    text(root, "", "title", plan.title);
    read_scene_of(root, plan.scene);
    read_design(root, plan);
    if (const json* value = member(root, "seed"))
      plan.seed = whole<std::uint64_t>(*value, "seed", 0, largest_whole);
    if (has_scene_) read_axes(root, plan);
    plan.outputs = read_sweep_outputs(root, folder_, paths_of(plan), problems);
    read_limits(root, plan.limits);
    if (problems.empty()) check_points(plan);
    return plan;
  }

 private:
  template <class Integer>
  Integer whole(const json& value, const std::string& path, double least, double most) {
    const double number = value.is_number() ? value.get<double>() : NAN;
    if (number >= least && number <= most && std::floor(number) == number)
      return static_cast<Integer>(number);
    problem(path, value, fmt::format("must be a whole number, >= {:.15g} and <= {:.15g}", least, most));
    return static_cast<Integer>(least);
  }

  // --- the scene ---

  void read_scene_of(const json& root, Scene& scene) {
    const json* value = required(root, "", "scene", "must be given: what is run at every point");
    if (!value) return;
    std::string scene_text, place = place_;
    MeshSource meshes{.folder = SceneFolder{folder_.string()}};
    if (value->is_object()) {
      scene_text = value->dump(-1, ' ', false, json::error_handler_t::replace);
    } else if (!value->is_string()) {
      return problem("scene", *value, "must be a scene in braces, the name of a built-in one or of a file");
    } else if (const BuiltinScene* builtin = find_builtin_scene(value->get<std::string>())) {
      scene_text = builtin->text;
      meshes.folder->built_in = true;
    } else {
      const fs::path file = folder_ / value->get<std::string>();
      if (const auto error = read_text_file(file, scene_text))
        return problem("scene", *value,
                       "is neither the name of a built-in scene nor a file: " + error->text());
      place = file.string();
      meshes.folder = SceneFolder{file.parent_path().string()};
    }
    SceneReading reading = read_runnable_scene(scene_text, place, settings_of(root), meshes);
    for (Problem& one : reading.problems) {
      const bool is_setting = one.place == "--set";
      if (!is_setting && place != place_) {
        problems.push_back(std::move(one));  // it has its place in the scene's own file
        continue;
      }
      one.path = joined_path(is_setting ? "set" : "scene", one.path);
      one.place.clear();
      one.line = one.column = 0;
      problems.push_back(std::move(one));
    }
    has_scene_ = reading.scene.has_value();
    if (has_scene_) scene = std::move(*reading.scene);
  }

  std::vector<Override> settings_of(const json& root) {
    std::vector<Override> settings;
    const json* set = member(root, "set");
    if (!set || !object(*set, "set", "must be an object of parameters: {\"duration\": 0.2}")) return settings;
    for (const auto& [key, value] : set->items())
      settings.push_back({key, value.dump(-1, ' ', false, json::error_handler_t::replace)});
    return settings;
  }

  // --- design and axes ---

  void read_design(const json& root, SweepPlan& plan) {
    if (const json* value = member(root, "design")) {
      const auto& names = sweep_design_names();
      const auto found = std::find(names.begin(), names.end(), *value);
      if (found == names.end())
        problem("design", *value, fmt::format("must be one of {}", fmt::join(names, ", ")));
      else
        plan.design = static_cast<SweepDesign>(found - names.begin());
    }
    is_sample_ = plan.design != SweepDesign::grid && plan.design != SweepDesign::points;
    const json* samples = member(root, "samples");
    if (samples && !is_sample_)
      problem("samples", *samples, fmt::format("is not for the design {}", name_of(plan.design)));
    else if (is_sample_ && required(root, "", "samples", "must be given for this design: how many") &&
             samples)
      plan.samples = whole<std::int64_t>(*samples, "samples", 1, 1e6);
  }

  void read_axes(const json& root, SweepPlan& plan) {
    const json* file = member(root, "points");
    Scene so_far = plan.scene;
    if (file) {
      if (plan.design != SweepDesign::points) return problem("points", *file, "needs \"design\": \"points\"");
      if (member(root, "vary")) return add_problem("points", "cannot be given together with vary");
      return read_table(*file, so_far, plan);
    }
    const json* vary = required(root, "", "vary", "must be given: a list of what is varied");
    if (!vary || !list(*vary, "vary")) return;
    if (vary->empty()) return problem("vary", *vary, "must vary something");
    if (plan.design == SweepDesign::points && vary->size() != 1)
      return problem("vary", *vary, "must be one list of values where the design is points");
    for (std::size_t k = 0; k < vary->size(); ++k)
      read_axis((*vary)[k], fmt::format("vary.{}", k), so_far, plan);
  }

  void read_axis(const json& value, const std::string& path, Scene& so_far, SweepPlan& plan) {
    if (!object(value, path)) return;
    known_keys(value, path, axis_keys);
    SweepAxis& axis = plan.axes.emplace_back();
    const auto parameters = read_paths(value, path, so_far, plan, axis);
    if (parameters.size() != axis.paths.size() || axis.paths.empty()) return;
    const json* values = member(value, "values");
    const bool has_range = member(value, "from") || member(value, "to");
    if ((values != nullptr) == has_range) return add_problem(path, "must have either values or from and to");
    if (values)
      read_values(*values, path + ".values", parameters, so_far, axis);
    else
      read_range(value, path, parameters, so_far, axis);
    for (const char* key : {"count", "scale"})
      if (const json* extra = member(value, key); extra && values)
        problem(joined_path(path, key), *extra, "is of a range, not of a list of values");
  }

  std::vector<SweptParameter> read_paths(const json& value, const std::string& path, const Scene& scene,
                                         const SweepPlan& plan, SweepAxis& axis) {
    std::vector<SweptParameter> found;
    const json *one = member(value, "path"), *several = member(value, "paths");
    if ((one != nullptr) == (several != nullptr)) {
      add_problem(path, "must have either path or paths: what is varied");
      return found;
    }
    const std::string at = path + (one ? ".path" : ".paths");
    if (several && (!list(*several, at) || several->empty())) {
      if (several->is_array()) problem(at, *several, "must name a parameter");
      return found;
    }
    const json all = one ? json::array({*one}) : *several;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const std::string place = one ? at : fmt::format("{}.{}", at, k);
      if (!all[k].is_string()) {
        problem(place, all[k], "must be the path of a parameter, in quotes");
        continue;
      }
      add_parameter(all[k].get<std::string>(), place, scene, plan, axis, found);
    }
    return found;
  }

  void add_parameter(const std::string& name, const std::string& place, const Scene& scene,
                     const SweepPlan& plan, SweepAxis& axis, std::vector<SweptParameter>& found) {
    const std::vector<std::string> before = paths_of(plan);
    if (std::find(before.begin(), before.end(), name) != before.end()) {
      problem(place, name, "is varied already");
      return;
    }
    axis.paths.push_back(name);
    auto parameter = SweptParameter::find(scene, name);
    if (auto* bad = std::get_if<Problem>(&parameter))
      problem(place, name, bad->rule);
    else
      found.push_back(std::move(std::get<SweptParameter>(parameter)));
  }

  void read_values(const json& value, const std::string& path, const std::vector<SweptParameter>& parameters,
                   Scene& so_far, SweepAxis& axis) {
    if (!list(value, path)) return;
    if (value.empty() || value.size() > most_values)
      return add_problem(path, fmt::format("must have 1 to {} values", most_values));
    const bool several = parameters.size() > 1;
    for (std::size_t k = 0; k < value.size(); ++k) {
      const std::string at = fmt::format("{}.{}", path, k);
      if (several && !(value[k].is_array() && value[k].size() == parameters.size())) {
        problem(at, value[k],
                fmt::format("must be a list with a value for each of the {} paths", parameters.size()));
        continue;
      }
      std::vector<ParameterValue> row;
      for (std::size_t p = 0; p < parameters.size(); ++p)
        add_value(several ? value[k][p] : value[k], several ? fmt::format("{}.{}", at, p) : at, parameters[p],
                  row);
      if (row.size() == parameters.size()) axis.values.push_back(std::move(row));
    }
    set_first(parameters, axis, so_far);
  }

  void add_value(const json& value, const std::string& path, const SweptParameter& parameter,
                 std::vector<ParameterValue>& row) {
    std::string rule;
    const auto typed = typed_value(parameter.info(), value, rule);
    if (!typed) return problem(path, value, rule);
    if (const auto broken = broken_rule(parameter.info(), *typed)) return problem(path, value, *broken);
    row.push_back(*typed);
  }

  /// Later axes may vary what the first values of this one bring about.
  void set_first(const std::vector<SweptParameter>& parameters, const SweepAxis& axis, Scene& so_far) {
    if (!problems.empty() || axis.values.empty()) return;
    for (std::size_t p = 0; p < parameters.size(); ++p) parameters[p].set(so_far, axis.values.front()[p]);
  }

  void read_range(const json& value, const std::string& path, const std::vector<SweptParameter>& parameters,
                  Scene& so_far, SweepAxis& axis) {
    if (const json* scale = member(value, "scale")) {
      if (*scale == "log")
        axis.scale = AxisScale::logarithmic;
      else if (*scale != "linear")
        problem(path + ".scale", *scale, "must be \"linear\" or \"log\"");
    }
    read_ends(value, path, "from", parameters, axis.from, axis.scale);
    read_ends(value, path, "to", parameters, axis.to, axis.scale);
    const json* count = member(value, "count");
    if (is_sample_) {
      if (count) problem(path + ".count", *count, "is of a grid: this design takes \"samples\"");
    } else if (required(value, path, "count", "must be given: how many values from end to end")) {
      axis.count = whole<int>(*count, path + ".count", 2, most_values);
    }
    for (std::size_t p = 0; p < std::min(axis.from.size(), axis.to.size()); ++p)
      if (!(axis.from[p] != axis.to[p])) add_problem(path + ".to", "must not be where the range begins");
    if (!problems.empty()) return;
    for (std::size_t p = 0; p < parameters.size(); ++p)
      parameters[p].set(so_far, parameters[p].info().kind == Kind::integer
                                    ? ParameterValue(std::int64_t(std::llround(axis.from[p])))
                                    : ParameterValue(axis.from[p]));
  }

  /// One end for all paths, or a list with one for each.
  void read_ends(const json& value, const std::string& path, const char* key,
                 const std::vector<SweptParameter>& parameters, std::vector<double>& ends, AxisScale scale) {
    const json* given = required(value, path, key);
    if (!given) return;
    const std::string at = joined_path(path, key);
    if (given->is_array() && given->size() != parameters.size())
      return problem(at, *given, fmt::format("must be a number, or a list of {}", parameters.size()));
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const json& one = given->is_array() ? (*given)[p] : *given;
      const ParameterInfo& info = parameters[p].info();
      if (info.kind != Kind::number && info.kind != Kind::integer)
        return problem(at, one, "is of a parameter that is no number: give values");
      std::vector<ParameterValue> typed;
      if (!one.is_number()) return problem(at, one, "must be a number");
      add_value(one, at, parameters[p], typed);
      if (scale == AxisScale::logarithmic && !(one.get<double>() > 0))
        return problem(at, one, "must be > 0 where the scale is log");
      ends.push_back(one.get<double>());
    }
  }

  /// A CSV file whose header has the paths: a row for each point.
  void read_table(const json& name, Scene& so_far, SweepPlan& plan) {
    if (!name.is_string()) return problem("points", name, "must be the name of a CSV file");
    std::string table_text;
    const fs::path file = folder_ / name.get<std::string>();
    if (const auto error = read_text_file(file, table_text)) return problem("points", name, error->text());
    const CsvTable table = parse_csv(table_text);
    if (table.rows.empty()) return problem("points", name, "has no rows under its header");
    SweepAxis& axis = plan.axes.emplace_back();
    std::vector<SweptParameter> parameters;
    for (const std::string& path : table.header) {
      const std::size_t before = problems.size();
      add_parameter(path, "points", so_far, plan, axis, parameters);
      for (std::size_t k = before; k < problems.size(); ++k)
        problems[k].place = file.string(), problems[k].line = 1, problems[k].path = path,
        problems[k].value.clear();
    }
    if (parameters.size() != table.header.size()) return;
    for (std::size_t r = 0; r < table.rows.size(); ++r) add_row(table, r, file.string(), parameters, axis);
    set_first(parameters, axis, so_far);
  }

  void add_row(const CsvTable& table, std::size_t r, const std::string& file,
               const std::vector<SweptParameter>& parameters, SweepAxis& axis) {
    const auto bad = [&](const std::string& path, const std::string& value, const std::string& rule) {
      problems.push_back({path, value, rule, file, static_cast<int>(r) + 2, 0});
    };
    const auto& fields = table.rows[r];
    if (fields.size() != parameters.size())
      return bad("", "", fmt::format("must have {} fields, as the header has", parameters.size()));
    std::vector<ParameterValue> row;
    for (std::size_t p = 0; p < fields.size(); ++p) {
      std::string rule;
      const auto typed = typed_value(parameters[p].info(), json_of_field(fields[p]), rule);
      if (!typed) {
        bad(table.header[p], fields[p], rule);
      } else if (const auto broken = broken_rule(parameters[p].info(), *typed)) {
        bad(table.header[p], fields[p], *broken);
      } else {
        row.push_back(*typed);
      }
    }
    if (row.size() == parameters.size()) axis.values.push_back(std::move(row));
  }

  // --- limits ---

  void read_limits(const json& root, SweepLimits& limits) {
    const json* value = member(root, "limits");
    if (!value || !object(*value, "limits")) return;
    known_keys(*value, "limits", std::vector<std::string>{"steps", "wall_s"});
    if (const json* steps = member(*value, "steps"))
      limits.steps = whole<std::int64_t>(*steps, "limits.steps", 1, 1e15);
    if (const json* wall = member(*value, "wall_s")) {
      number(*value, "limits", "wall_s", limits.wall);
      if (wall->is_number() && !(limits.wall > 0)) problem("limits.wall_s", *wall, "must be > 0");
    }
  }

  void check_points(const SweepPlan& plan) {
    if (const auto bad = broken_sample(plan)) {
      problems.push_back(*bad);
    } else if (const auto count = point_count(plan); count > most_sweep_points) {
      add_problem("vary", fmt::format("makes {} points; at most {} are run", count, most_sweep_points));
    }
  }

  std::string place_;
  fs::path folder_;
  bool has_scene_ = false, is_sample_ = false;
};

}  // namespace

SweepReading read_sweep(const std::string& text, const std::string& place,
                        const std::optional<fs::path>& folder) {
  if (auto problem = syntax_problem(text, place)) return {std::nullopt, {std::move(*problem)}};
  const JsonLocations locations = locate_json(text);
  SweepReader reader(place, folder.value_or(fs::path(place).parent_path()));
  reader.problems = locations.repetitions();
  SweepPlan plan = reader.read(json::parse(text));
  if (reader.problems.empty()) return {std::move(plan), {}};
  for (Problem& problem : reader.problems)
    if (problem.place.empty()) locations.put_in_place(problem, place);
  sort_by_place(reader.problems);
  return {std::nullopt, std::move(reader.problems)};
}

}  // namespace cloth
