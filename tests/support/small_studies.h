// Studies that are made within moments.
#pragma once

#include "study/stability_map.h"

namespace cloth::test {

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
