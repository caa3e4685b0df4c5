// What a step of the built-in scenes costs, each with its own method, beside the bare Verlet step of a grid
// of as many particles: at the scene's own grid, or refined to a given number of particles along its longer
// side.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "study/order_estimate.h"

namespace cloth::speed {

struct SceneSpeed {
  std::string name{}, method{};
  int size = 0;               ///< particles along the longer side that were asked for; 0: the scene's own
  int rows = 0, columns = 0;  ///< 0 of a mesh
  int particles = 0;
  double time_step = 0;    ///< s
  double duration = 0;     ///< s, of the scene
  double simulated = 0;    ///< s, of what is timed
  double seconds = 0;      ///< of stepping alone: processor time of one thread, wall time of several
  double nanoseconds = 0;  ///< per particle and step
  double bare = 0;         ///< the same of the bare Verlet step: springs in six directions and gravity
  std::string remark{};    ///< how it diverged, or why it was not run

  double speed() const { return seconds > 0 ? simulated / seconds : 0; }
  double to_bare() const { return bare > 0 ? nanoseconds / bare : 0; }
};

/// The scene with `size` particles along the longer side of its grid and cells of the same proportions; with
/// the step `auto` where its own would no longer be stable. nullopt, with the reason in `why`: its cloth has
/// no grid of its own, or rules of scenes forbid it.
std::optional<Scene> refined(const Scene& scene, int size, std::string& why);

/// Steps from the start to the scene's end or until `longest` seconds of stepping have passed, in turns of a
/// few milliseconds with the bare step, of which the median of all turns is taken. The first step is not
/// timed.
SceneSpeed measure_scene(const std::string& name, const Scene& scene, double longest, int threads);

/// How the time of a step grows with the number of particles.
struct SceneGrowth {
  std::string name;
  int smallest = 0, largest = 0;  ///< particles
  Slope exponent = {};            ///< with its standard error from three sizes on
};

/// Of each scene that was timed at two numbers of particles or more, in the order of the rows.
std::vector<SceneGrowth> fit_scene_growth(const std::vector<SceneSpeed>& rows);

}  // namespace cloth::speed
