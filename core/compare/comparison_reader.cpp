#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "compare/comparison_json.h"
#include "scene/builtin_scenes.h"
#include "scene/json_locator.h"
#include "scene/json_syntax.h"
#include "scene/scene_parameters.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

const std::set<std::string> root_keys{"format", "title", "scene", "panes", "reference"};
const std::set<std::string> pane_keys{"name", "title", "own"};

std::string shown(const json& value) {
  constexpr std::size_t longest = 60;
  std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() > longest) text = text.substr(0, longest - 3) + "...";
  return text;
}

/// Reads own values through the reader of scenes: a pane's scene is the shared one with its values set.
class ComparisonReader {
 public:
  ComparisonReader(std::string place, const std::vector<Override>& overrides)
      : place_(std::move(place)), overrides_(overrides) {}

  std::vector<Problem> problems;

  Comparison read(const json& root) {
    Comparison comparison;
    if (!root.is_object()) {
      problem("", root, "must be an object in braces");
      return comparison;
    }
    known_keys(root, "", root_keys);
    if (const auto format = root.find("format"); format != root.end() && *format != comparison_format)
      problem("format", *format, fmt::format("must be \"{}\"", comparison_format));
    read_text(root, "title", "title", comparison.title);
    if (const auto scene = root.find("scene"); scene != root.end())
      read_shared_scene(*scene, comparison.scene);
    else
      problems.push_back({"scene", "", "must be given: what the panes run", "", 0, 0});
    if (const auto panes = root.find("panes"); panes != root.end())
      read_panes(*panes, comparison);
    else
      problems.push_back({"panes", "", "must be given: two to four panes", "", 0, 0});
    read_text(root, "reference", "reference", comparison.reference);
    return comparison;
  }

 private:
  void problem(const std::string& path, const json& value, const std::string& rule) {
    problems.push_back({path, shown(value), rule, "", 0, 0});
  }

  void known_keys(const json& from, const std::string& path, const std::set<std::string>& known) {
    for (const auto& [key, value] : from.items())
      if (!known.count(key))
        problems.push_back({path + key, "",
                            fmt::format("is not a known key; known here: {}", fmt::join(known, ", ")), "", 0,
                            0});
  }

  bool read_text(const json& from, const std::string& key, const std::string& path, std::string& into) {
    const auto value = from.find(key);
    if (value == from.end()) return false;
    if (value->is_string())
      into = value->get<std::string>();
    else
      problem(path, *value, "must be a text in quotes");
    return value->is_string();
  }

  void read_shared_scene(const json& value, Scene& scene) {
    if (value.is_string()) {
      const BuiltinScene* builtin = find_builtin_scene(value.get<std::string>());
      if (!builtin) {
        std::vector<std::string> names;
        for (const BuiltinScene& known : builtin_scenes()) names.push_back(known.name);
        return problem("scene", value,
                       fmt::format("must be a scene in braces or the name of a built-in one: {}",
                                   fmt::join(names, ", ")));
      }
      scene_text_ = builtin->text;
      meshes_.folder = SceneFolder{.path = "", .built_in = true};
    } else if (value.is_object()) {
      scene_text_ = value.dump(-1, ' ', false, json::error_handler_t::replace);
    } else {
      return problem("scene", value, "must be a scene in braces or the name of a built-in one");
    }
    SceneReading reading = read_scene(scene_text_, place_, overrides_, meshes_);
    for (Problem& problem : reading.problems) {
      problem.path = problem.path.empty() ? "scene" : "scene." + problem.path;
      problems.push_back(std::move(problem));
    }
    has_scene_ = reading.scene.has_value();
    if (has_scene_) scene = *reading.scene;
  }

  void read_panes(const json& value, Comparison& comparison) {
    if (!value.is_array()) return problem("panes", value, "must be a list of two to four panes");
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string path = fmt::format("panes.{}", i);
      Pane& pane = comparison.panes.emplace_back();
      if (i < most_panes) pane.name = pane_names[i];
      if (!value[i].is_object()) {
        problem(path, value[i], "must be an object in braces");
        continue;
      }
      known_keys(value[i], path + ".", pane_keys);
      read_text(value[i], "name", path + ".name", pane.name);
      read_text(value[i], "title", path + ".title", pane.title);
      if (const auto own = value[i].find("own"); own != value[i].end())
        read_own(*own, path, comparison.scene, pane);
    }
  }

  void read_own(const json& value, const std::string& path, const Scene& shared, Pane& pane) {
    if (!value.is_object())
      return problem(path + ".own", value,
                     "must be an object of parameters: {\"integrator.method\": \"rk4\"}");
    std::vector<Override> settings = overrides_;
    for (const auto& [key, own] : value.items()) {
      const std::string at = path + ".own." + key;
      if (const auto rule = must_be_shared(key))
        problem(at, own, *rule);
      else if (own.is_null())
        problem(at, own, "must be a value; the whole comparison can be without a block, not one pane");
      else
        settings.push_back({key, own.dump(-1, ' ', false, json::error_handler_t::replace)});
    }
    if (has_scene_) read_values(settings, path, shared, pane);
  }

  void read_values(const std::vector<Override>& settings, const std::string& path, const Scene& shared,
                   Pane& pane) {
    const SceneReading reading =
        read_scene(scene_text_, place_, settings, {.folder = meshes_.folder, .known = &shared});
    const auto is_own = [&](const std::string& key) {
      return std::any_of(settings.begin() + static_cast<std::ptrdiff_t>(overrides_.size()), settings.end(),
                         [&](const Override& own) { return own.path == key; });
    };
    for (Problem problem : reading.problems) {
      problem.path = path + (is_own(problem.path) ? ".own." : ".") + problem.path;
      problem.place.clear();
      problems.push_back(std::move(problem));
    }
    if (!reading.scene) return;
    Scene base = shared;  // what the pane would run with nothing of its own but the method
    base.integrator.method = reading.scene->integrator.method;
    for (std::size_t k = overrides_.size(); k < settings.size(); ++k) {
      const auto parameter = find_parameter(base, settings[k].path);
      if (parameter)
        pane.own.push_back({settings[k].path, parameter->get(*reading.scene)});
      else
        problems.push_back({path + ".own." + settings[k].path, "",
                            "is not a parameter of the shared scene: a pane changes values, and what is not "
                            "there is shared by all",
                            "", 0, 0});
    }
  }

  std::string place_;
  const std::vector<Override>& overrides_;
  std::string scene_text_;
  MeshSource meshes_;
  bool has_scene_ = false;
};

}  // namespace

ComparisonReading read_comparison(const std::string& text, const std::string& place,
                                  const std::vector<Override>& overrides) {
  if (auto problem = syntax_problem(text, place)) return {std::nullopt, {std::move(*problem)}};
  const JsonLocations locations = locate_json(text);
  ComparisonReader reader(place, overrides);
  for (const std::string& path : locations.repeated)
    reader.problems.push_back({path, "", "is given more than once", "", 0, 0});
  Comparison comparison = reader.read(json::parse(text));
  if (reader.problems.empty()) reader.problems = find_problems(comparison);
  if (reader.problems.empty()) reader.problems = find_start_problems(comparison);
  if (reader.problems.empty()) return {std::move(comparison), {}};

  for (Problem& problem : reader.problems) {
    if (!problem.place.empty() && problem.place != place) continue;  // an option's
    problem.place = place;
    const TextPosition at = locations.place_of(problem.path, problem.value.empty());
    problem.line = at.line, problem.column = at.column;
  }
  std::stable_sort(reader.problems.begin(), reader.problems.end(), [](const Problem& a, const Problem& b) {
    return std::pair(a.line, a.column) < std::pair(b.line, b.column);
  });
  return {std::nullopt, std::move(reader.problems)};
}

}  // namespace cloth
