#include "scene/builtin_scenes.h"

#include <algorithm>
#include <cassert>

namespace cloth {

const BuiltinScene* find_builtin_scene(const std::string& name) {
  const auto& scenes = builtin_scenes();
  const auto found =
      std::find_if(scenes.begin(), scenes.end(), [&](const BuiltinScene& s) { return s.name == name; });
  return found == scenes.end() ? nullptr : &*found;
}

Scene builtin_scene(const std::string& name) {
  const BuiltinScene* found = find_builtin_scene(name);
  assert(found != nullptr);
  const SceneReading reading = read_scene(found->text, name, {}, {SceneFolder{"", true}});
  assert(reading.scene.has_value());
  return *reading.scene;
}

}  // namespace cloth
