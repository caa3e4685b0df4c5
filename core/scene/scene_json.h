// Scenes as JSON: reading with every problem at once, writing, and the JSON Schema of the format.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "params/problem.h"
#include "scene/scene.h"

namespace cloth {

inline constexpr const char* scene_format = "clothlab/scene/1";

/// Sets one parameter before the scene is checked: `value` is JSON ("3", "\"auto\"", "[0, 0, 3]") or a bare
/// word.
struct Override {
  std::string path;
  std::string value;
};

/// "springs.structural=500" as an override; nullopt without "=".
std::optional<Override> parse_override(const std::string& text);

/// A scene, or the problems because of which there is none: exactly one of the two.
struct SceneReading {
  std::optional<Scene> scene;
  std::vector<Problem> problems;
};

/// Where read_scene finds the mesh files of a scene.
struct MeshSource {
  std::optional<SceneFolder> folder = {};  ///< none: that of `place`
  const Scene* known = nullptr;            ///< meshes that this scene has already are not read again
};

/// An additional check of a scene; returns its problems.
using SceneCheck = std::function<std::vector<Problem>(const Scene&)>;

/// `place` names the text in messages. `further` looks at a scene that has no other problem; its problems get
/// their places in the text too. A scene that is to be run from its start is read by read_runnable_scene
/// (contact/start_check.h).
SceneReading read_scene(const std::string& text, const std::string& place,
                        const std::vector<Override>& overrides = {}, const MeshSource& meshes = {},
                        const SceneCheck& further = {});

/// Writes every value, defaults resolved, with numbers that read back to the same bits.
std::string write_scene(const Scene& scene);

/// One parameter's value as write_scene has it.
std::string value_json(const ParameterValue& value);

/// JSON Schema (draft 7) of the scene file, and of one parameter's value.
std::string scene_schema();
std::string value_schema_json(const ParameterInfo& info);

/// 64-bit FNV-1a of write_scene and of what is in the meshes, as 16 hexadecimal digits.
std::string scene_hash(const Scene& scene);

}  // namespace cloth
