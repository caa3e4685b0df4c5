#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "compare/comparison_json.h"
#include "contact/start_check.h"
#include "io/json_reader.h"
#include "io/json_syntax.h"
#include "scene/builtin_scenes.h"
#include "scene/scene_parameters.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

const std::vector<std::string> root_keys{"format", "title", "scene", "panes", "reference"};
const std::vector<std::string> pane_keys{"name", "title", "own"};

/// Reads own values through the reader of scenes: a pane's scene is the shared one with its values set.
class ComparisonReader : public JsonReader<json> {
 public:
  ComparisonReader(std::string place, const std::vector<Override>& overrides, SceneFolder folder)
      : place_(std::move(place)), overrides_(overrides), meshes_{.folder = std::move(folder)} {}

  Comparison read(const json& root) {
    Comparison comparison;
    if (!object(root, "")) return comparison;
    known_keys(root, "", root_keys);
    format(root, comparison_format);
    text(root, "", "title", comparison.title);
    if (const json* scene = required(root, "", "scene", "must be given: what the panes run"))
      read_shared_scene(*scene, comparison.scene);
    if (const json* panes = required(root, "", "panes", "must be given: two to four panes"))
      read_panes(*panes, comparison);
    text(root, "", "reference", comparison.reference);
    return comparison;
  }

 private:
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
      meshes_.folder->built_in = true;
    } else if (value.is_object()) {
      scene_text_ = value.dump(-1, ' ', false, json::error_handler_t::replace);
    } else {
      return problem("scene", value, "must be a scene in braces or the name of a built-in one");
    }
    SceneReading reading = read_runnable_scene(scene_text_, place_, overrides_, meshes_);
    add_problems("scene", std::move(reading.problems));
    has_scene_ = reading.scene.has_value();
    if (has_scene_) scene = *reading.scene;
  }

  void read_panes(const json& value, Comparison& comparison) {
    if (!list(value, "panes", "must be a list of two to four panes")) return;
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::string path = fmt::format("panes.{}", i);
      Pane& pane = comparison.panes.emplace_back();
      if (i < max_panes) pane.name = pane_names[i];
      if (!object(value[i], path)) continue;
      known_keys(value[i], path, pane_keys);
      text(value[i], path, "name", pane.name);
      text(value[i], path, "title", pane.title);
      if (const json* own = member(value[i], "own")) read_own(*own, path, comparison.scene, pane);
    }
  }

  void read_own(const json& value, const std::string& path, const Scene& shared, Pane& pane) {
    if (!object(value, path + ".own", "must be an object of parameters: {\"integrator.method\": \"rk4\"}"))
      return;
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
        add_problem(path + ".own." + settings[k].path,
                    "is not a parameter of the shared scene: a pane changes values, and what is not there is "
                    "shared by all");
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
                                  const std::vector<Override>& overrides,
                                  const std::optional<SceneFolder>& folder) {
  if (auto problem = syntax_problem(text, place)) return {std::nullopt, {std::move(*problem)}};
  const JsonLocations locations = locate_json(text);
  const std::string beside = std::filesystem::path(place).parent_path().string();
  ComparisonReader reader(place, overrides, folder.value_or(SceneFolder{beside}));
  reader.problems = locations.repetitions();
  Comparison comparison = reader.read(json::parse(text));
  if (reader.problems.empty()) reader.problems = find_problems(comparison);
  if (reader.problems.empty()) reader.problems = find_start_problems(comparison);
  if (reader.problems.empty()) return {std::move(comparison), {}};

  for (Problem& problem : reader.problems) {
    if (!problem.place.empty() && problem.place != place) continue;  // an option's
    locations.put_in_place(problem, place);
  }
  sort_by_place(reader.problems);
  return {std::nullopt, std::move(reader.problems)};
}

}  // namespace cloth
