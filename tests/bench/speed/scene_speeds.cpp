#include "bench/speed/scene_speeds.h"

#include <chrono>

#include "bench/speed/step_costs.h"
#include "simulation/simulation.h"

namespace cloth::speed {

SceneSpeed measure_scene(const std::string& name, const Scene& scene, double longest, int threads) {
  using Clock = std::chrono::steady_clock;
  Simulation simulation(scene);
  use_threads(simulation, threads);
  SceneSpeed result{.name = name,
                    .method = scene.integrator.method,
                    .particles = simulation.system().size(),
                    .time_step = simulation.time_step(),
                    .remark = {}};
  const auto start = Clock::now();
  while (simulation.time() < scene.duration && result.wall < longest) {
    const auto divergence = simulation.step();
    result.wall = std::chrono::duration<double>(Clock::now() - start).count();
    if (!divergence) continue;
    result.remark = describe(*divergence);
    break;
  }
  result.simulated = simulation.time();
  const double steps = static_cast<double>(simulation.count().steps);
  if (steps > 0) result.nanoseconds = 1e9 * result.wall / steps / result.particles;
  return result;
}

}  // namespace cloth::speed
