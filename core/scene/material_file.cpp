#include "scene/material_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "io/json_reader.h"
#include "io/json_syntax.h"
#include "io/printable.h"
#include "io/text_file.h"
#include "scene/block_fields.h"
#include "scene/material_reading.h"

namespace cloth {
namespace {

/// A material has few values: what is larger is something else.
constexpr std::size_t largest_material_text = std::size_t{1} << 20;

class MaterialFileReader : public JsonReader<nlohmann::json> {
 public:
  MaterialFile read(nlohmann::json root) {
    MaterialFile file;
    if (!object(root, "")) return file;
    known_keys(root, "", std::vector<std::string>{"format", "title", "source", "material"});
    format(root, material_format);
    utf8_text(root, "", "title", file.title);
    if (const auto* source = member(root, "source"); source && object(*source, "source"))
      read_source(*source, file.source);
    if (!required(root, "", "material") || !object(root["material"], "material")) return file;
    for (Problem& problem : settle_bending_45(root["material"])) problems.push_back(std::move(problem));
    read_material(root["material"], file.material);
    return file;
  }

 private:
  void utf8_text(const nlohmann::json& from, const std::string& path, const std::string& key,
                 std::string& into) {
    text(from, path, key, into);
    if (!is_utf8(into)) problem(joined_path(path, key), from[key], "must be UTF-8 text");
  }

  void read_source(const nlohmann::json& source, MaterialSource& into) {
    known_keys(source, "source", std::vector<std::string>{"author", "year", "measured", "assumed"});
    utf8_text(source, "source", "author", into.author);
    utf8_text(source, "source", "measured", into.measured);
    utf8_text(source, "source", "assumed", into.assumed);
    const auto* year = member(source, "year");
    if (!year) return;
    if (year->is_number_integer() && year->get<double>() > 0 && year->get<double>() < 10000)
      into.year = year->get<int>();
    else
      problem("source.year", *year, "must be a whole number, > 0 and < 10000");
  }

  void read_material(const nlohmann::json& from, Material& material) {
    std::vector<std::string> known{"bending_45"};
    for (const Field<Material>& field : material_fields()) {
      known.push_back(field.info.key);
      const std::string path = joined_path("material", field.info.key);
      const auto* value = member(from, field.info.key);
      const bool is_auto = value && field.info.auto_allowed && *value == "auto";
      if (is_auto) continue;
      if (value && !value->is_number()) {
        problem(path, *value, field.info.auto_allowed ? "must be a number or \"auto\"" : "must be a number");
        continue;
      }
      if (value) field.set(material, value->get<double>());
      const ParameterValue number = field.get(material);
      if (const auto rule = broken_rule(field.info, number))
        problems.push_back({path, value_text(field.info, number), *rule});
    }
    known_keys(from, "material", known);
  }
};

}  // namespace

std::string MaterialSource::text() const {
  return year > 0 ? fmt::format("{}{}{}", author, author.empty() ? "" : " ", year) : author;
}

MaterialFileReading read_material_file(const std::string& text, const std::string& place) {
  if (auto problem = syntax_problem(text, place)) return {std::nullopt, {std::move(*problem)}};
  const JsonLocations locations = locate_json(text);
  MaterialFileReader reader;
  reader.problems = locations.repetitions();
  MaterialFile file = reader.read(nlohmann::json::parse(text));
  if (reader.problems.empty()) return {std::move(file), {}};
  for (Problem& problem : reader.problems) locations.put_in_place(problem, place);
  sort_by_place(reader.problems);
  return {std::nullopt, std::move(reader.problems)};
}

std::string write_material_file(const MaterialFile& file) {
  nlohmann::ordered_json root{{"format", material_format}, {"title", file.title}};
  nlohmann::ordered_json source = nlohmann::ordered_json::object();
  if (!file.source.author.empty()) source["author"] = file.source.author;
  if (file.source.year > 0) source["year"] = file.source.year;
  if (!file.source.measured.empty()) source["measured"] = file.source.measured;
  if (!file.source.assumed.empty()) source["assumed"] = file.source.assumed;
  if (!source.empty()) root["source"] = std::move(source);
  for (const Field<Material>& field : material_fields())
    if (const ParameterValue value = field.get(file.material); std::holds_alternative<double>(value))
      root["material"][field.info.key] = std::get<double>(value);
  return root.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

const BuiltinMaterial* find_builtin_material(const std::string& name) {
  const auto& all = builtin_materials();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const BuiltinMaterial& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

MaterialFile builtin_material(const std::string& name) {
  const BuiltinMaterial* found = find_builtin_material(name);
  assert(found != nullptr);
  MaterialFileReading reading = read_material_file(found->text, name);
  assert(reading.file.has_value());
  return *std::move(reading.file);
}

PresetReading read_preset(const std::string& name, const SceneFolder& folder) {
  if (name.find('/') == std::string::npos && !name.ends_with(".json")) {
    if (find_builtin_material(name)) return {builtin_material(name), {}};
    std::string names;
    for (const BuiltinMaterial& one : builtin_materials()) names += (names.empty() ? "" : ", ") + one.name;
    return {std::nullopt, fmt::format("must be {}, or a file like \"./mine.material.json\"", names)};
  }
  const std::filesystem::path path = std::filesystem::path(folder.path) / name;
  std::string text;
  if (const auto error = read_text_file(path, text, largest_material_text))
    return {std::nullopt, "cannot be used: " + error->message};
  MaterialFileReading reading = read_material_file(text, path.filename().string());
  if (reading.file) return {std::move(reading.file), {}};
  std::string rule = "cannot be used";
  for (const Problem& problem : reading.problems)
    rule += fmt::format("{}{}", &problem == &reading.problems[0] ? ": " : "; ", problem.text());
  return {std::nullopt, std::move(rule)};
}

}  // namespace cloth
