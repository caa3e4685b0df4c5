// The scenes of resources/scenes, compiled in.
#pragma once

#include <string>
#include <vector>

#include "scene/scene_json.h"

namespace cloth {

struct BuiltinScene {
  std::string name;
  std::string title;  ///< That of the text, known without building the scene's meshes.
  std::string text;  ///< JSON
};

const std::vector<BuiltinScene>& builtin_scenes();

/// The scene that opens when none is named.
inline constexpr const char* default_scene_name = "corners-shear";

/// nullptr if there is none of that name.
const BuiltinScene* find_builtin_scene(const std::string& name);

/// A built-in scene that must exist, parsed.
Scene builtin_scene(const std::string& name);

}  // namespace cloth
