#include "scene/material_reading.h"

#include <fmt/format.h>

#include "cloth/material.h"
#include "io/json_reader.h"
#include "io/printable.h"
#include "scene/block_fields.h"
#include "scene/material_file.h"

namespace cloth {
namespace {

struct Replaced {
  const char* object;  ///< in which it stands; empty: the scene itself
  const char* key;
  const char* by;
};

constexpr Replaced replaced[] = {
    {"", "springs", "stretch_warp, stretch_weft, shear and bending"},
    {"", "damping", "material.mass_damping"},
    {"cloth", "mass", "material.areal_density"},
    {"air", "drag", "material.drag_normal"},
    {"air", "skin_friction", "material.drag_tangential"},
};

double number_of(const nlohmann::json& material, const char* key) {
  const auto found = material.find(key);
  return found != material.end() && found->is_number() ? found->get<double>() : 0;
}

PresetReading preset_named(const nlohmann::json& name, const SceneFolder& folder) {
  if (name.is_string() && is_utf8(name.get_ref<const std::string&>()))
    return read_preset(name.get<std::string>(), folder);
  return {std::nullopt, "must be the name of a material or of its file"};
}

/// Fills in what the preset has and the material does not give.
void settle_preset(nlohmann::json& material, const SceneFolder& folder, std::vector<Problem>& problems) {
  const auto given = material.find("preset");
  if (given == material.end()) return;
  const nlohmann::json name = *given;
  material.erase(given);
  const PresetReading preset = preset_named(name, folder);
  if (!preset.file) {
    problems.push_back({"material.preset", shown_json(name), preset.rule});
    material.emplace("areal_density", 1);  // that it is missing is not said too
    return;
  }
  const bool has_twist = material.contains("bending_45");
  for (const Field<Material>& field : material_fields())
    if (!material.contains(field.info.key) && !(has_twist && field.info.key == "twist"))
      if (const ParameterValue value = field.get(preset.file->material); std::holds_alternative<double>(value))
        material[field.info.key] = std::get<double>(value);
}

}  // namespace

void name_preset(nlohmann::json& root) {
  const auto material = root.is_object() ? root.find("material") : root.end();
  if (!root.is_object() || material == root.end() || !material->is_string()) return;
  *material = nlohmann::json{{"preset", *material}};
}

std::vector<TakenOut> take_out_replaced(nlohmann::json& root) {
  std::vector<TakenOut> taken;
  for (const Replaced& one : replaced) {
    const bool at_root = *one.object == '\0';
    nlohmann::json* owner = at_root ? &root : root.contains(one.object) ? &root[one.object] : nullptr;
    if (!owner || !owner->is_object() || !owner->contains(one.key)) continue;
    const std::string path = at_root ? one.key : fmt::format("{}.{}", one.object, one.key);
    taken.push_back({path, (*owner)[one.key], one.by});
    owner->erase(one.key);
  }
  return taken;
}

std::vector<Problem> settle_bending_45(nlohmann::json& material) {
  const auto given = material.find("bending_45");
  if (given == material.end()) return {};
  const nlohmann::json value = *given;
  material.erase("bending_45");
  const auto refuse = [&](const std::string& rule) {
    return std::vector<Problem>{{"material.bending_45", shown_json(value), rule}};
  };
  if (!value.is_number() || !(value.get<double>() >= 0)) return refuse("must be a number >= 0, in N m");
  if (material.contains("twist"))
    return refuse("must be left out beside material.twist: one follows from the other");
  const double warp = number_of(material, "bending_warp"), weft = number_of(material, "bending_weft");
  const double twist = twist_from(warp, weft, value.get<double>());
  if (twist < 0)
    return refuse(
        fmt::format("must be at least a quarter of bending_warp + bending_weft, {} N m: a cloth that "
                    "bends so easily at 45 degrees would gain energy by twisting",
                    0.25 * (warp + weft)));
  material["twist"] = twist;
  return {};
}

std::vector<Problem> settle_material(nlohmann::json& root, const SceneFolder& folder) {
  std::vector<Problem> problems;
  if (!root.is_object() || !root.contains("material")) return problems;
  for (const TakenOut& one : take_out_replaced(root))
    problems.push_back({one.path, one.value.is_number() ? one.value.dump() : "",
                        fmt::format("must be left out beside \"material\", which has {} for it", one.by)});
  name_preset(root);
  nlohmann::json& material = root["material"];
  if (!material.is_object()) return problems;
  settle_preset(material, folder, problems);
  for (Problem& problem : settle_bending_45(material)) problems.push_back(std::move(problem));
  return problems;
}

}  // namespace cloth
