#include "scene/material_reading.h"

#include <fmt/format.h>

#include "cloth/material.h"

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

void settle_twist(nlohmann::json& material, std::vector<Problem>& problems) {
  const auto given = material.find("bending_45");
  if (given == material.end()) return;
  const nlohmann::json value = *given;
  material.erase("bending_45");
  const auto refuse = [&](const std::string& rule) {
    problems.push_back({"material.bending_45", value.dump(), rule});
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
}

}  // namespace

std::vector<Problem> settle_material(nlohmann::json& root) {
  std::vector<Problem> problems;
  const auto material = root.is_object() ? root.find("material") : root.end();
  if (!root.is_object() || material == root.end()) return problems;
  for (const Replaced& one : replaced) {
    const bool at_root = *one.object == '\0';
    nlohmann::json* owner = at_root ? &root : root.contains(one.object) ? &root[one.object] : nullptr;
    if (!owner || !owner->is_object() || !owner->contains(one.key)) continue;
    const std::string path = at_root ? one.key : fmt::format("{}.{}", one.object, one.key);
    const nlohmann::json& value = (*owner)[one.key];
    problems.push_back({path, value.is_number() ? value.dump() : "",
                        fmt::format("must be left out beside \"material\", which has {} for it", one.by)});
    owner->erase(one.key);
  }
  if (nlohmann::json& object = root["material"]; object.is_object()) settle_twist(object, problems);
  return problems;
}

}  // namespace cloth
