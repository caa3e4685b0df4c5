#include <map>
#include <nlohmann/json.hpp>

#include "scene/block_fields.h"
#include "scene/blocks.h"
#include "scene/material_file.h"
#include "scene/method_facts.h"
#include "scene/obstacle_shape.h"
#include "scene/scene_json.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

json number_schema(const ParameterInfo& declared) {
  const ParameterInfo info = within_physical_bounds(declared);
  json schema{{"type", "number"}};
  if (info.minimum > -infinity) schema[info.minimum_excluded ? "exclusiveMinimum" : "minimum"] = info.minimum;
  if (info.maximum < infinity) schema["maximum"] = info.maximum;
  return schema;
}

json value_schema(const ParameterInfo& info) {
  switch (info.kind) {
    case Kind::number: {
      const json number = number_schema(info);
      if (!info.auto_allowed) return number;
      return {{"anyOf", json::array({number, json{{"const", "auto"}}})}};
    }
    case Kind::integer: {
      json schema = number_schema(info);
      schema["type"] = "integer";
      return schema;
    }
    case Kind::vector:
      return {{"type", "array"}, {"items", number_schema(info)}, {"minItems", 3}, {"maxItems", 3}};
    case Kind::choice:
      return {{"enum", info.choices}};
    case Kind::words:
      return {{"enum", info.word_sets}};
    case Kind::text:
      return {{"type", "string"}};
  }
  return json::object();
}

json described(const ParameterInfo& info) {
  json schema = value_schema(info);
  schema["title"] = info.label;
  schema["description"] = info.unit.empty() ? info.doc : info.doc + " In " + info.unit + ".";
  return schema;
}

template <class List>
json object_schema(const List& fields, json properties = json::object()) {
  for (const auto& field : fields) properties[field.info.key] = described(field.info);
  return {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

json pins_schema() {
  json names = json::array();
  for (int pin = 0; pin < named_pin_count; ++pin) names.push_back(name_of(static_cast<NamedPin>(pin)));
  const json particle{
      {"type", "array"}, {"items", {{"type", "integer"}, {"minimum", 0}}}, {"minItems", 2}, {"maxItems", 2}};
  const json radius{{"type", "number"}, {"exclusiveMinimum", 0}};
  const json disc{{"type", "object"},
                  {"properties", {{"disc", radius}}},
                  {"required", {"disc"}},
                  {"additionalProperties", false}};
  return {{"type", "array"},
          {"items", {{"anyOf", json::array({json{{"enum", names}}, particle, disc})}}},
          {"description",
           "Pinned particles: names of corners and edges, [row, column], or all within a disc "
           "around the sheet's middle, by its radius in m."}};
}

json vertex_pins_schema() {
  return {{"type", "array"},
          {"items", {{"type", "integer"}, {"minimum", 0}}},
          {"description", "Pinned particles: numbers of the mesh's vertices, from 0."}};
}

/// A grid, or a mesh.
json cloth_schema() {
  json grid = object_schema(cloth_fields(false)), mesh = object_schema(cloth_fields(true));
  grid["properties"]["pins"] = pins_schema();
  mesh["properties"]["pins"] = vertex_pins_schema();
  mesh["required"] = {"mesh"};
  return {{"anyOf", json::array({std::move(grid), std::move(mesh)})}};
}

json obstacles_schema() {
  json shapes = json::array();
  for (const ObstacleShape* shape : obstacle_shapes()) {
    json entry = object_schema(obstacle_fields(shape), {{"shape", {{"const", shape->name}}}});
    entry["properties"].update(object_schema(motion_fields())["properties"]);
    entry["properties"]["keyframes"] = {{"type", "array"}, {"items", object_schema(keyframe_fields())}};
    entry["required"] = shape->is_from_file ? json::array({"shape", "file"}) : json::array({"shape"});
    shapes.push_back(std::move(entry));
  }
  return {{"type", "array"}, {"items", {{"anyOf", std::move(shapes)}}}};
}

/// An alternative for each measure; of a particle its place on a grid, or its number on a mesh.
json probes_schema() {
  const json number{{"type", "integer"}, {"minimum", 0}};
  const json place{{"type", "array"}, {"items", number}, {"minItems", 2}, {"maxItems", 2}};
  json measures = json::array();
  for (const ProbeFacts& facts : probe_facts()) {
    json entry = object_schema(probe_fields(facts.measure), {{"measure", {{"const", facts.name}}}});
    entry["description"] = facts.doc;
    entry["properties"]["name"]["pattern"] = "^[A-Za-z][A-Za-z0-9_-]{0,31}$";
    entry["required"] = json::array({"name", "measure"});
    if (facts.is_of_particles()) {
      entry["properties"]["particles"] = {{"type", "array"},
                                          {"items", {{"anyOf", json::array({place, number})}}},
                                          {"minItems", facts.least_particles},
                                          {"maxItems", facts.most_particles}};
      entry["required"].push_back("particles");
    }
    measures.push_back(std::move(entry));
  }
  return {{"type", "array"}, {"items", {{"anyOf", std::move(measures)}}}};
}

/// An alternative for every set of methods with the same settings.
json integrator_schema() {
  std::map<MethodSettings, json> alternatives;
  const std::string unnamed = IntegratorChoice{}.method;
  for (const MethodFacts& facts : integrator_facts()) {
    json& entry = alternatives[facts.settings];
    if (entry.is_null()) {
      entry = object_schema(integrator_fields(facts.name));
      entry["properties"]["method"]["enum"] = json::array();
    }
    entry["properties"]["method"]["enum"].push_back(facts.name);
  }
  json list = json::array();
  for (auto& [settings, entry] : alternatives) {
    if (settings != facts_of(unnamed).settings) entry["required"] = {"method"};
    list.push_back(std::move(entry));
  }
  return {{"type", "object"}, {"anyOf", std::move(list)}};
}

/// The values of a material; bending_45 stands for twist.
json material_values() {
  json values = object_schema(material_fields());
  json bending_45 = values["properties"]["bending_warp"];
  bending_45["title"] = "Bending stiffness at 45 degrees";
  bending_45["description"] = "In place of twist: 2 bending_45 - (bending_warp + bending_weft)/2. In N m.";
  values["properties"]["bending_45"] = std::move(bending_45);
  values["not"] = {{"required", {"twist", "bending_45"}}};
  return values;
}

/// The name of a preset, or an object that may name one.
json material_block() {
  json names = json::array();
  for (const BuiltinMaterial& one : builtin_materials()) names.push_back(one.name);
  const json preset{
      {"description", "A built-in material, or a file as seen from the scene's folder."},
      {"anyOf", json::array({json{{"enum", names}}, json{{"type", "string"}, {"pattern", "/|\\.json$"}}})}};
  json values = material_values();
  values["properties"]["preset"] = preset;
  return {{"anyOf", json::array({preset, std::move(values)})}};
}

/// Where the schema of a value or object has its place below `root`; objects on the way are made.
json& schema_at(json& root, const std::string& path) {
  const std::string parent = parent_path(path);
  json& above = parent.empty() ? root : schema_at(root, parent);
  if (above.is_null()) above = object_schema(Fields<Scene>{});
  return above["properties"][path.substr(path.rfind('.') + 1)];
}

/// Of the blocks that are objects, and of the values of the root.
void put_blocks(json& root, bool objects) {
  const Scene scene;
  for (const BlockRow* row : block_rows_of_file()) {
    if (objects && row->path == "cloth") root["properties"]["cloth"] = cloth_schema();
    if (objects && row->path == "obstacles") root["properties"]["obstacles"] = obstacles_schema();
    if (objects && row->path == "probes") root["properties"]["probes"] = probes_schema();
    if (objects && row->path == "integrator") root["properties"]["integrator"] = integrator_schema();
    if (objects && row->path == "material") root["properties"]["material"] = material_block();
    if (row->path == "cloth" || row->path == "integrator" || row->path == "material") continue;
    for (const Parameter& parameter : row->parameters(scene))
      if (objects != parent_path(parameter.path).empty())
        schema_at(root, parameter.path) = described(parameter.info);
  }
}

}  // namespace

std::string value_schema_json(const ParameterInfo& info) {
  return described(info).dump();
}

std::string scene_schema() {
  json root{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Clothlab scene"}};
  root.update(object_schema(Fields<Scene>{}, {{"format", {{"const", scene_format}}}}));
  put_blocks(root, true);
  put_blocks(root, false);
  root["required"] = {"cloth"};
  return root.dump(2) + "\n";
}

std::string material_schema() {
  json root{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Clothlab material"}};
  const json text{{"type", "string"}}, year{{"type", "integer"}, {"minimum", 1}, {"maximum", 9999}};
  const json source = object_schema(
      Fields<Material>{}, {{"author", text}, {"year", year}, {"measured", text}, {"assumed", text}});
  json values = material_values();
  values["required"] = {"areal_density"};
  root.update(object_schema(Fields<Material>{}, {{"format", {{"const", material_format}}},
                                                 {"title", text},
                                                 {"source", source},
                                                 {"material", std::move(values)}}));
  root["required"] = {"material"};
  return root.dump(2) + "\n";
}

}  // namespace cloth
