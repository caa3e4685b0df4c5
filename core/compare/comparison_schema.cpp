#include <nlohmann/json.hpp>

#include "compare/comparison_json.h"
#include "integrators/registry.h"
#include "scene/builtin_scenes.h"
#include "scene/obstacle_shape.h"
#include "scene/scene_parameters.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

/// A scene with every block there is, and one obstacle of each shape.
Scene full_scene(const std::string& method) {
  Scene scene;
  add_every_block(scene);
  for (const Shape shape : obstacle_shapes()) scene.obstacles.emplace_back().shape = shape;
  scene.integrator.method = method;
  return scene;
}

/// Settings of one key that methods declare differently: any of them.
void allow(json& properties, const std::string& key, const json& schema) {
  if (!properties.contains(key)) {
    properties[key] = schema;
  } else if (properties[key] != schema) {
    json either = properties[key].contains("anyOf") && !properties[key].contains("title")
                      ? properties[key]["anyOf"]
                      : json::array({properties[key]});
    if (std::find(either.begin(), either.end(), schema) == either.end()) either.push_back(schema);
    properties[key] = json{{"anyOf", either}};
  }
}

/// The values that a pane can have of its own, by dotted path.
json own_schema() {
  json named = json::object(), obstacles = json::object();
  const std::string prefix = "obstacles.";
  for (const std::string& method : integrator_names())
    for (const Parameter& parameter : parameters_of(full_scene(method))) {
      if (must_be_shared(parameter.path)) continue;
      const json schema = json::parse(value_schema_json(parameter.info));
      if (parameter.path.rfind(prefix, 0) == 0)
        allow(obstacles, "^obstacles\\.[0-9]+\\." + parameter.info.key + "$", schema);
      else
        allow(named, parameter.path, schema);
    }
  return {{"type", "object"},
          {"description", "Values that this pane has of its own, by the dotted path of the parameter."},
          {"properties", named},
          {"patternProperties", obstacles},
          {"additionalProperties", false}};
}

json scene_or_name() {
  json scene = json::parse(scene_schema());
  scene.erase("$schema");
  json names = json::array();
  for (const BuiltinScene& builtin : builtin_scenes()) names.push_back(builtin.name);
  return {{"anyOf", json::array({scene, json{{"enum", names}}})}};
}

}  // namespace

std::string comparison_schema() {
  json names = json::array(), references = json::array({controlled_reference, no_reference});
  for (const char* name : pane_names) {
    names.push_back(name);
    references.push_back(name);
  }
  const json pane{{"type", "object"},
                  {"properties",
                   {{"name", {{"enum", names}, {"description", "What files and tables call the pane by."}}},
                    {"title", {{"type", "string"}, {"description", "The pane for people."}}},
                    {"own", own_schema()}}},
                  {"additionalProperties", false}};
  json root{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Clothlab comparison"}};
  root["type"] = "object";
  root["properties"] = {
      {"format", {{"const", comparison_format}}},
      {"title", {{"type", "string"}}},
      {"scene", scene_or_name()},
      {"panes", {{"type", "array"}, {"items", pane}, {"minItems", least_panes}, {"maxItems", max_panes}}},
      {"reference",
       {{"enum", references},
        {"description",
         "What errors are measured against: a pane, the shared scene under error control, or nothing."}}}};
  root["required"] = {"scene", "panes"};
  root["additionalProperties"] = false;
  return root.dump(2) + "\n";
}

}  // namespace cloth
