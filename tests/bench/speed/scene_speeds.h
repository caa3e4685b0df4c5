// Simulated seconds per second of the wall clock on the built-in scenes, each with its own method.
#pragma once

#include <functional>
#include <string>

#include "scene/scene.h"

namespace cloth::speed {

struct SceneSpeed {
  std::string name, method;
  int particles = 0;
  double time_step = 0;    ///< s
  double simulated = 0;    ///< s
  double wall = 0;         ///< s, of stepping alone
  double nanoseconds = 0;  ///< per particle and step
  std::string remark;      ///< how it diverged

  double speed() const { return wall > 0 ? simulated / wall : 0; }
};

/// Steps from the start to the scene's end or until `longest` seconds have passed.
SceneSpeed measure_scene(const std::string& name, const Scene& scene, double longest, int threads);

}  // namespace cloth::speed
