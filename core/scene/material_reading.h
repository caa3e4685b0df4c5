// What a file may say of a material beyond its parameters, and what it may not say beside it.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "params/problem.h"
#include "scene/scene_mesh.h"

namespace cloth {

/// Writes "material": "NAME" as the object that it stands for, { "preset": "NAME" }, so that its values can
/// be set one by one.
void name_preset(nlohmann::json& root);

/// Takes out what a material replaces; the paths that there were, with their values.
struct TakenOut {
  std::string path;
  nlohmann::json value;
  const char* by;  ///< what a material has in its place
};
std::vector<TakenOut> take_out_replaced(nlohmann::json& root);

/// Where a scene has a "material": fills in the values of its preset that it does not give itself, takes out
/// of `root` what a material replaces ("springs", "damping", "cloth.mass", "air.drag", "air.skin_friction"),
/// with a problem for each, and puts "twist" in place of "bending_45".
std::vector<Problem> settle_material(nlohmann::json& root, const SceneFolder& folder);

/// In a material, puts "twist" in place of "bending_45".
std::vector<Problem> settle_bending_45(nlohmann::json& material);

}  // namespace cloth
