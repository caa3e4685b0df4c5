// What a file may say of a material beyond its parameters, and what it may not say beside it.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "params/problem.h"

namespace cloth {

/// Where a scene has a "material": takes out of `root` what a material replaces ("springs", "damping",
/// "cloth.mass", "air.drag", "air.skin_friction"), with a problem for each, and puts "twist" in place of
/// "bending_45".
std::vector<Problem> settle_material(nlohmann::json& root);

}  // namespace cloth
