// Studies that are made within moments.
#pragma once

#include "scene/builtin_scenes.h"
#include "study/stability_map.h"

namespace cloth::test {

inline Scene small_cloth() {
  Scene scene = builtin_scene("corners-free");
  scene.cloth.rows = scene.cloth.columns = 4;
  return scene;
}

/// Two methods, four steps, three stiffnesses.
inline StabilityOptions small_map(const Scene& scene) {
  StabilityOptions options{.methods = {"verlet", "rk4"}};
  options.x = default_time_axis(scene, options.methods);
  options.x.count = 4;
  options.y = {.path = "springs.structural", .low = 50, .high = 500, .count = 3};
  options.criterion.periods = 20;
  return options;
}

}  // namespace cloth::test
