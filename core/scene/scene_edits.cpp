#include "scene/scene_edits.h"

#include <nlohmann/json.hpp>

#include "params/parameter.h"
#include "scene/scene_json.h"

namespace cloth {
namespace {

using json = nlohmann::ordered_json;

/// Walks two documents side by side down to the first difference of each branch.
void compare(const json& before, const json& after, const std::string& path, std::vector<SceneEdit>& edits) {
  if (before == after) return;
  const bool same_list = before.is_array() && after.is_array() && before.size() == after.size() &&
                         !after.empty() && after.front().is_object();
  if (same_list) {
    for (std::size_t i = 0; i < after.size(); ++i)
      compare(before[i], after[i], joined_path(path, std::to_string(i)), edits);
    return;
  }
  if (!before.is_object() || !after.is_object()) {
    edits.push_back({path, after.dump()});
    return;
  }
  for (const auto& [key, value] : after.items())
    if (before.contains(key))
      compare(before[key], value, joined_path(path, key), edits);
    else
      edits.push_back({joined_path(path, key), value.dump()});
  for (const auto& [key, value] : before.items())
    if (!after.contains(key)) edits.push_back({joined_path(path, key), "null"});
}

}  // namespace

std::vector<SceneEdit> edits_between(const Scene& before, const Scene& after) {
  std::vector<SceneEdit> edits;
  compare(json::parse(write_scene(before)), json::parse(write_scene(after)), "", edits);
  return edits;
}

SceneReading edited_scene(const Scene& scene, const std::vector<SceneEdit>& edits) {
  std::vector<Override> overrides;
  overrides.reserve(edits.size());
  for (const SceneEdit& edit : edits) overrides.push_back({edit.path, edit.value});
  return read_scene(write_scene(scene), "", overrides, {scene.folder, &scene});
}

}  // namespace cloth
