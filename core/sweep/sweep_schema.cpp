#include <nlohmann/json.hpp>

#include "scene/builtin_scenes.h"
#include "sweep/sweep_plan.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

json described(const char* type, const char* text) {
  return {{"type", type}, {"description", text}};
}

json positive(json entry) {
  entry["exclusiveMinimum"] = 0;
  return entry;
}

json whole(const char* text, std::int64_t least) {
  return {{"type", "integer"}, {"minimum", least}, {"description", text}};
}

/// A number, or a list with one for each path.
json end(const char* text) {
  json list{{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 1}};
  return {{"anyOf", json::array({json{{"type", "number"}}, list})}, {"description", text}};
}

json axis_schema() {
  json paths{{"type", "array"}, {"items", {{"type", "string"}}}, {"minItems", 1}};
  paths["description"] = "Several that take their values together";
  json values{{"type", "array"}, {"minItems", 1}};
  values["description"] = "A list; of several paths each entry is a list with a value for each";
  json axis{{"type", "object"}};
  axis["properties"] = {
      {"path", described("string", "The dotted path of a parameter, or springs.*: all stiffnesses")},
      {"paths", paths},
      {"values", values},
      {"from", end("Where a range begins")},
      {"to", end("Where it ends")},
      {"count", whole("How many values a grid takes of it", 2)},
      {"scale", {{"enum", {"linear", "log"}}}}};
  axis["additionalProperties"] = false;
  const auto has = [](const char* key) { return json{{"required", json::array({key})}}; };
  axis["allOf"] =
      json::array({json{{"oneOf", json::array({has("path"), has("paths")})}},
                   json{{"oneOf", json::array({has("values"), json{{"required", {"from", "to"}}}})}}});
  return axis;
}

json output_schema() {
  json curve{{"type", "object"}, {"required", {"times", "values"}}, {"additionalProperties", false}};
  const json numbers{{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 1}};
  curve["properties"] = {{"file", {{"type", "string"}}}, {"times", numbers}, {"values", numbers}};
  json output{{"type", "object"}, {"required", {"of"}}, {"additionalProperties", false}};
  json window{{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}};
  window["description"] = "Rows between these times in s count";
  output["properties"] = {
      {"name", described("string", "Its column in sweep.csv; without it what it is of")},
      {"of", described("string", "A column of record.csv, or a measure of the shape")},
      {"reduce", {{"enum", reduction_names()}}},
      {"window", window},
      {"bound", described("number", "Of first-above, first-below and stays-below")},
      {"measured",
       {{"anyOf", json::array({json{{"type", "string"}}, curve})},
        {"description", "Of rms: a CSV file with a measured curve"}}},
      {"time_column", described("string", "Of that file; without it time_s")},
      {"value_column", described("string", "Of that file; without it what the output is of")}};
  return output;
}

}  // namespace

std::string sweep_schema() {
  json scene = json::parse(scene_schema());
  scene.erase("$schema");
  json root{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "Clothlab sweep"}};
  root["type"] = "object";
  json limits{{"type", "object"}, {"additionalProperties", false}};
  limits["properties"] = {{"steps", whole("A point of more steps is not run to its end", 1)},
                          {"wall_s", positive(described("number", "A point that takes longer is ended"))}};
  root["properties"] = {
      {"format", {{"const", sweep_format}}},
      {"title", {{"type", "string"}}},
      {"scene",
       {{"anyOf", json::array({json{{"type", "string"}}, scene})},
        {"description", "A scene in braces, the name of a built-in one, or of a file beside this one"}}},
      {"set", described("object", "Values that all points share, by the dotted path of the parameter")},
      {"vary", {{"type", "array"}, {"items", axis_schema()}, {"minItems", 1}}},
      {"design", {{"enum", sweep_design_names()}}},
      {"points", described("string", "Of the design points: a CSV file with the paths in its header")},
      {"samples", whole("Of designs that are samples: how many", 1)},
      {"seed", whole("Of designs that are samples", 0)},
      {"outputs", {{"type", "array"}, {"items", output_schema()}, {"minItems", 1}}},
      {"limits", limits}};
  root["required"] = {"scene", "outputs"};
  root["additionalProperties"] = false;
  return root.dump(2) + "\n";
}

}  // namespace cloth
